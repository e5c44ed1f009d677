/// What the program tells its user on stderr; a terminal or a pipe that is gone is no reason to stop.
#pragma once
#include <fmt/format.h>
#include <string>
#include <vector>

namespace vkpm {

/// Writes a text, as it is, to a file and flushes it; whether that worked. From any thread.
bool writeText(std::FILE* file, const std::string& text);

/// Prints "vkpm: ..." and ends the line.
template <class... Values> void say(fmt::format_string<Values...> text, Values&&... values) {
    writeText(stderr, "vkpm: " + fmt::format(text, std::forward<Values>(values)...) + "\n");
}

/// Prints "vkpm: warning: ..." and keeps the text for warnings().
void warn(const std::string& text);

/// All warnings so far.
std::vector<std::string> warnings();

} // namespace vkpm
