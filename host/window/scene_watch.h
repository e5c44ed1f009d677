/// Whether a scene has changed on disk.
#pragma once
#include <filesystem>
#include <map>

namespace vkpm {

/// Looks at the scene file and at the meshes and imports that it names, buffers of these included.
class SceneWatch {
public:
    explicit SceneWatch(std::filesystem::path scene);

    /// Whether a file has changed since the last call or since the beginning; one that is being replaced, once it is
    /// there.
    bool changed();

private:
    struct Stamp {
        std::filesystem::file_time_type time;
        std::uintmax_t bytes;
        bool operator==(const Stamp&) const = default;
    };
    void lookForFiles(const std::filesystem::path& file);

    std::filesystem::path scene;
    std::map<std::filesystem::path, Stamp> stamps;
};

} // namespace vkpm
