/// Hashes and differences of scenes and settings.
#include "scene/identity.h"
#include "scene/hash.h"
#include "scene/settings_json.h"
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vkpm {
namespace {

using nlohmann::json;

/// A hash of what arrays hold, word by word.
class ArrayHash : public Hash {
public:
    using Hash::add;

    template <class T> void add(const std::vector<T>& items) {
        static_assert(sizeof(T) % 4 == 0);
        add(std::uint32_t(items.size()));
        for (const T& item : items) addWords(item);
    }

    template <class T> void addWords(const T& item) {
        std::uint32_t words[sizeof(T) / 4];
        std::memcpy(words, &item, sizeof(T));
        for (const std::uint32_t word : words) add(word);
    }
};

std::string sceneHash(const Scene& scene) {
    ArrayHash hash;
    hash.add(scene.triangleCount);
    hash.add(scene.primitives);
    hash.add(scene.normals);
    hash.add(scene.materials);
    hash.add(scene.lights);
    if (!scene.skyTexels.empty()) {
        hash.add(scene.skyTexels);
        hash.addWords(scene.sky);
    }
    if (!scene.media.empty()) hash.add(scene.media);
    hash.add(scene.targets);
    const View& v = scene.view;
    const struct {
        vec3 origin, target, up;
        float fieldOfView;
        Coordinates coordinates;
    } pinhole{v.origin, v.target, v.up, v.fieldOfView, v.coordinates};
    hash.addWords(pinhole);
    if (v.lens.aperture > 0) hash.addWords(v.lens);
    if (!scene.textured.images.empty()) {
        hash.add(scene.textured.materials);
        hash.add(scene.textured.lights);
        hash.add(scene.textured.textures);
        hash.add(scene.textured.images);
        hash.add(scene.textured.texels);
        hash.add(scene.textured.coordinates);
        hash.add(scene.textured.colors);
        if (!scene.textured.tangents.empty()) hash.add(scene.textured.tangents);
    }
    return hash.text();
}

/// What of a scene file makes its picture, settings aside: these are compared as they came out.
json essence(const std::string& text) {
    json scene = json::parse(text, nullptr, false);
    if (scene.is_object())
        for (const char* key : {"$schema", "about", "settings", "film"}) scene.erase(key);
    return scene;
}

std::vector<std::string> sceneDifferences(const std::string& here, const std::string& there) {
    std::vector<std::string> lines;
    for (const json& change : json::diff(essence(here), essence(there))) {
        if (lines.size() == 5) {
            lines.push_back("scene: ...");
            break;
        }
        lines.push_back("scene: " + change["path"].get<std::string>());
    }
    return lines;
}

/// Files whose bytes differ, or that one of the two has not.
std::vector<std::string> fileDifferences(const std::string& here, const std::string& there) {
    std::vector<std::string> lines;
    const json a = json::parse(here, nullptr, false), b = json::parse(there, nullptr, false);
    if (!a.is_object() || !b.is_object()) return lines;
    for (const json& change : json::diff(a, b))
        lines.push_back("scene: what the file \"" + json::json_pointer{change["path"].get<std::string>()}.back() +
                        "\" holds");
    return lines;
}

std::vector<std::string> settingsDifferences(const std::string& here, const std::string& there) {
    const json a = json::parse(here, nullptr, false);
    const json b = json::parse(there, nullptr, false);
    if (!a.is_object() || !b.is_object()) return {"settings: not readable"};
    std::vector<std::string> lines;
    const auto text = [](const json& object, const std::string& key) {
        return object.contains(key) ? object[key].dump() : "none given";
    };
    json all = a;
    all.update(b);
    for (const auto& [key, value] : all.items())
        if (text(a, key) != text(b, key))
            lines.push_back(fmt::format("{}: {} here, {} there", key, text(a, key), text(b, key)));
    return lines;
}

} // namespace

std::map<std::string, std::string> identityOf(const Scene& scene, const Settings& settings) {
    std::map<std::string, std::string> identity{{"version", VKPM_VERSION},
                                                {"scene", scene.text},
                                                {"sceneHash", sceneHash(scene)},
                                                {"settings", settingsJson(settings)},
                                                {"seed", std::to_string(settings.seed)}};
    if (!scene.fileHashes.empty()) identity["files"] = json(scene.fileHashes).dump();
    identity["settingsHash"] = hashText(identity["version"] + identity["sceneHash"] + identity["settings"]);
    return identity;
}

std::vector<std::string> differences(const std::map<std::string, std::string>& here,
                                     const std::map<std::string, std::string>& there) {
    const auto value = [](const auto& map, const char* key) { return map.contains(key) ? map.at(key) : std::string(); };
    if (value(here, "settingsHash") == value(there, "settingsHash")) return {};
    std::vector<std::string> lines;
    if (value(here, "version") != value(there, "version"))
        lines.push_back(fmt::format("version: {} here, {} there", value(here, "version"), value(there, "version")));
    if (value(here, "sceneHash") != value(there, "sceneHash")) {
        const std::size_t before = lines.size();
        for (const std::string& line : sceneDifferences(value(here, "scene"), value(there, "scene")))
            lines.push_back(line);
        for (const std::string& line : fileDifferences(value(here, "files"), value(there, "files")))
            lines.push_back(line);
        if (lines.size() == before) lines.push_back("scene: what its meshes and imports hold");
    }
    for (const std::string& line : settingsDifferences(value(here, "settings"), value(there, "settings")))
        lines.push_back(line);
    if (lines.empty()) lines.push_back("settingsHash: damaged");
    return lines;
}

} // namespace vkpm
