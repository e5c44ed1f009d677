/// The log of events.
#include "output/event_log.h"
#include "output/messages.h"
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace vkpm {

EventLog::EventLog(const std::optional<std::filesystem::path>& name, bool append)
    : path(name.value_or("")), appends(append), waits(name.has_value()) {}

void EventLog::open() {
    const std::lock_guard lock(writing);
    if (!std::exchange(waits, false)) return;
    file.reset(std::fopen(path.c_str(), appends ? "a" : "w"));
    if (!file) throw std::runtime_error(fmt::format("{}: fopen: {}", path.string(), std::strerror(errno)));
    put(std::exchange(waiting, {}));
}

void EventLog::write(const char* name, const nlohmann::ordered_json& members) {
    const std::lock_guard lock(writing);
    if (!file && !waits) return;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    nlohmann::ordered_json line{{"event", name}, {"seconds", seconds}};
    line.update(members);
    const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (waits) waiting += text;
    else put(text);
}

/// Under the lock.
void EventLog::put(const std::string& text) {
    if (writeText(file.get(), text)) return;
    warn(fmt::format("{}: {}; the log ends here", path.string(), std::strerror(errno)));
    file.reset();
}

} // namespace vkpm
