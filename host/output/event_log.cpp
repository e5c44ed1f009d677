/// The log of events.
#include "output/event_log.h"
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>

namespace vkpm {

EventLog::EventLog(const std::optional<std::filesystem::path>& name, bool append) {
    if (!name) return;
    path = *name;
    file.reset(std::fopen(path.c_str(), append ? "a" : "w"));
    if (!file) throw std::runtime_error(fmt::format("{}: fopen: {}", path.string(), std::strerror(errno)));
}

void EventLog::write(const char* name, const nlohmann::ordered_json& members) {
    if (!file) return;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    nlohmann::ordered_json line{{"event", name}, {"seconds", seconds}};
    line.update(members);
    fmt::print(file.get(), "{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    if (std::fflush(file.get()) == 0) return;
    fmt::print(stderr, "vkpm: warning: {}: {}; the log ends here\n", path.string(), std::strerror(errno));
    file.reset();
}

} // namespace vkpm
