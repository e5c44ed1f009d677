/// Messages and warnings.
#include "output/messages.h"
#include <cstdio>
#include <mutex>

namespace vkpm {
namespace {

std::mutex keeping;
std::vector<std::string> kept;

} // namespace

bool writeText(std::FILE* file, const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    return std::fflush(file) == 0 && written;
}

void warn(const std::string& text) {
    say("warning: {}", text);
    const std::lock_guard lock(keeping);
    kept.push_back(text);
}

std::vector<std::string> warnings() {
    const std::lock_guard lock(keeping);
    return kept;
}

} // namespace vkpm
