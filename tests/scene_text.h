/// Scenes given as JSON in tests: written to a file of their own and loaded from there.
#pragma once
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <unistd.h>

namespace vkpm {

/// A sphere with a light above it; member by member overridden by tests.
inline nlohmann::json smallScene() {
    return nlohmann::json::parse(R"({
        "camera": {"origin": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfView": 40},
        "film": {"size": [8, 4], "exposure": 1},
        "settings": {"passes": 2, "photons": 10, "causticPhotons": 10, "radius": 0.1, "causticRadius": 0.1, "nearest": 5, "pixelSamples": 3, "gatherRays": 2,
                     "kernel": "cone", "fresnel": "schlick", "seed": 7},
        "materials": {"grey": {"type": "diffuse", "albedo": 0.5}, "steel": {"type": "mirror", "reflectance": [0.9, 0.8, 0.7]},
                      "water": {"type": "glass", "ior": 1.33, "exteriorIor": 1, "tint": 1}},
        "shapes": [
            {"name": "ball", "type": "sphere", "center": [0, 0, 0], "radius": 0.5, "material": "grey",
             "transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"translate": [0, 0, 0]},
                           {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]},
            {"type": "rectangle", "corner": [-1, 2, -1], "edges": [[2, 0, 0], [0, 0, 2]], "emission": [1, 2, 3],
             "twoSided": false}]})");
}

/// A file in a folder that only this process uses.
inline std::filesystem::path writeScene(const std::string& text, const std::string& name = "scene.json") {
    const auto folder = std::filesystem::temp_directory_path() / ("vkpm-scene-test-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream{folder / name, std::ios::binary} << text;
    return folder / name;
}

inline Scene loadText(const std::string& text) { return loadScene(writeScene(text)); }
inline Scene loadJson(const nlohmann::json& json) { return loadText(json.dump()); }

/// The message with which a file is refused; empty if it is accepted.
inline std::string errorOf(const std::filesystem::path& file) {
    try {
        loadScene(file);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}
inline std::string errorOf(const nlohmann::json& json) { return errorOf(writeScene(json.dump())); }

} // namespace vkpm
