/// Times and sizes of a scene's files.
#include "window/scene_watch.h"
#include "scene/gltf_file.h"
#include <fstream>
#include <nlohmann/json.hpp>

namespace vkpm {

namespace {

using nlohmann::json;

/// The JSON of a scene, a .gltf or a .glb; discarded if there is none.
json jsonOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string begin(20, '\0');
    stream.read(begin.data(), 20);
    if (!begin.starts_with("glTF")) stream.clear(), stream.seekg(0); // else it follows the header
    json value;
    try {
        stream >> value;
    } catch (const json::exception&) {
        return json::value_t::discarded;
    }
    return value;
}

/// What a value of JSON names: itself, or its member of that name.
std::string nameIn(const json& value, const char* key) {
    const json& name = value.is_object() && value.contains(key) ? value[key] : value;
    return name.is_string() ? name.get<std::string>() : "";
}

} // namespace

SceneWatch::SceneWatch(std::filesystem::path file) : scene(std::move(file)) {
    stamps[scene];
    lookForFiles(scene);
    changed();
}

/// Adds those that a file names as it is now; while it cannot be read, those of before remain.
void SceneWatch::lookForFiles(const std::filesystem::path& file) {
    const json content = jsonOf(file);
    if (!content.is_object()) return;
    std::vector<std::string> names;
    for (const auto& [list, key] : {std::pair{"shapes", "file"}, {"buffers", "uri"}})
        if (content.contains(list) && content[list].is_array())
            for (const json& element : content[list]) names.push_back(nameIn(element, key));
    if (content.contains("import")) names.push_back(nameIn(content["import"], "file"));
    for (const std::string& name : names) {
        const std::filesystem::path named = file.parent_path() / name;
        if (name.empty() || name.starts_with("data:")) continue;
        stamps.try_emplace(named);
        if (file == scene && isGltfName(named)) lookForFiles(named);
    }
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
    if (any) lookForFiles(scene);
    return any;
}

} // namespace vkpm
