/// Times and sizes of a scene's files.
#include "window/scene_watch.h"
#include <fstream>
#include <nlohmann/json.hpp>

namespace vkpm {

SceneWatch::SceneWatch(std::filesystem::path file) : scene(std::move(file)) {
    stamps[scene];
    lookForMeshes();
    changed();
}

/// Adds those of the scene as it is now; while it cannot be read, those of before remain.
void SceneWatch::lookForMeshes() {
    std::ifstream file(scene);
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object() || !json.contains("shapes") || !json["shapes"].is_array()) return;
    for (const auto& shape : json["shapes"])
        if (shape.is_object() && shape.contains("file") && shape["file"].is_string())
            stamps.try_emplace(scene.parent_path() / shape["file"].get<std::string>());
}

bool SceneWatch::changed() {
    bool any = false;
    for (auto& [file, stamp] : stamps) {
        std::error_code problem;
        const Stamp now{std::filesystem::last_write_time(file, problem), std::filesystem::file_size(file, problem)};
        if (problem || now == stamp) continue;
        stamp = now;
        any = true;
    }
    if (any) lookForMeshes();
    return any;
}

} // namespace vkpm
