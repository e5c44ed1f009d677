/// What happens during a render, as JSON lines that can be followed while it runs.
#pragma once
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace vkpm {

/// Any thread may call its functions.
class EventLog {
public:
    /// Without a file it is silent; `append` adds to what the file has.
    explicit EventLog(const std::optional<std::filesystem::path>& file, bool append);

    /// Opens the file, once it is known that nothing is lost by that, and writes what was to be written before. Throws
    /// std::runtime_error with file and cause.
    void open();

    /// Writes one line, {"event": name, "seconds": since the log was made, ...}, and flushes it. If that fails, the log
    /// ends.
    void write(const char* name, const nlohmann::ordered_json& members = nlohmann::ordered_json::object());

private:
    struct Close {
        void operator()(std::FILE* open) const { std::fclose(open); }
    };
    void put(const std::string& text);

    std::filesystem::path path;
    bool appends = false;
    bool waits = false; // to be opened
    std::string waiting;
    std::mutex writing;
    std::unique_ptr<std::FILE, Close> file;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

} // namespace vkpm
