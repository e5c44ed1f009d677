/// What happens during a render, as JSON lines that can be followed while it runs.
#pragma once
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

namespace vkpm {

class EventLog {
public:
    /// Opens the file, at its end if `append`; without a file it is silent. Throws std::runtime_error with file and cause.
    EventLog(const std::optional<std::filesystem::path>& file, bool append);

    /// Writes one line, {"event": name, "seconds": since the log was opened, ...}, and flushes it. From any thread.
    void write(const char* name, const nlohmann::ordered_json& members = nlohmann::ordered_json::object());

private:
    struct Close {
        void operator()(std::FILE* open) const { std::fclose(open); }
    };
    std::filesystem::path path;
    std::mutex writing;
    std::unique_ptr<std::FILE, Close> file;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

} // namespace vkpm
