/// Models of glTF for tests: JSON with what its accessors read, as .glb or as .gltf.
#pragma once
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vkpm {

struct GltfText {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string bytes;

    /// Adds an accessor with its view of the buffer; returns its index.
    template <class T> std::size_t add(const std::vector<T>& values, const char* type, nlohmann::json more = {}) {
        const std::size_t components = std::string{"SCALAR"} == type ? 1
                                       : std::string{"VEC2"} == type ? 2
                                       : std::string{"VEC3"} == type ? 3
                                                                     : 4;
        more.update({{"bufferView", addView(values)},
                     {"componentType", componentType<T>()},
                     {"count", values.size() / components},
                     {"type", type}});
        json["accessors"].push_back(more);
        return json["accessors"].size() - 1;
    }

    template <class T> std::size_t addView(const std::vector<T>& values) {
        const std::size_t length = values.size() * sizeof(T);
        bytes.resize((bytes.size() + 3) / 4 * 4);
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", length}});
        bytes.append(reinterpret_cast<const char*>(values.data()), length);
        return json["bufferViews"].size() - 1;
    }

    std::string glb() const {
        nlohmann::json whole = json;
        whole["buffers"] = {{{"byteLength", bytes.size()}}};
        return glbOf(whole.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), bytes);
    }

    /// With a buffer in a file beside it, or of another name.
    std::string gltf(const std::string& uri) const {
        nlohmann::json whole = json;
        whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
        return whole.dump(1);
    }

    static std::string glbOf(std::string text, std::string binary) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4);
        return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
               word(binary.size()) + std::string("BIN\0", 4) + binary;
    }

private:
    static std::string word(std::size_t value) {
        std::string text(4, '\0');
        for (std::size_t i = 0; i < 4; i++) text[i] = static_cast<char>(value >> 8 * i);
        return text;
    }
    template <class T> static int componentType() {
        if (std::is_same_v<T, float>) return 5126;
        return sizeof(T) == 1   ? (std::is_signed_v<T> ? 5120 : 5121)
               : sizeof(T) == 2 ? (std::is_signed_v<T> ? 5122 : 5123)
                                : 5125;
    }
};

/// A square of two triangles from (0, 0, 0) to (1, 1, 0) at one node.
inline GltfText squareModel() {
    GltfText model;
    const auto points = model.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const auto indices = model.add<unsigned short>({0, 1, 2, 0, 2, 3}, "SCALAR");
    model.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", points}}}, {"indices", indices}}}}}};
    model.json["nodes"] = {{{"mesh", 0}}};
    return model;
}

/// A model with a little of everything that vkpm reads.
inline GltfText fullModel() {
    GltfText model = squareModel();
    nlohmann::json& json = model.json;
    const auto normals = model.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const auto bytes =
        model.add<signed char>({0, 0, 0, 127, 0, 0, 0, 127, 0, 127, 127, 64}, "VEC3", {{"normalized", true}});
    const auto sparse = model.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3");
    json["accessors"][sparse]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", model.addView<unsigned char>({1})}, {"componentType", 5121}}},
        {"values", {{"bufferView", model.addView<float>({2, 0, 0})}}}};
    const auto shifts = model.add<float>({0, 0, -1, 0, 0, -2}, "VEC3");
    const auto turns = model.add<float>({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4");
    json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
    json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        model.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, -1}, "VEC4");
    json["meshes"][0]["primitives"][0]["material"] = 0;
    json["meshes"].push_back({{"primitives",
                               {{{"attributes", {{"POSITION", bytes}}}, {"mode", 5}, {"material", 1}},
                                {{"attributes", {{"POSITION", sparse}}}, {"mode", 6}, {"material", 2}},
                                {{"attributes", {{"POSITION", sparse}}}, {"mode", 1}}}}});
    json["materials"] = nlohmann::json::parse(R"([
        {"name": "matt", "doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0}},
        {"name": "lamp", "emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}},
        {"name": "pane", "alphaMode": "BLEND", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.4},
                        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [1, 0.5, 1]}}}])");
    json["nodes"] = nlohmann::json::parse(R"([
        {"mesh": 0, "children": [1, 2, 3], "scale": [2, 2, -2]}, {"mesh": 1, "rotation": [0, 0.6, 0, 0.8], "translation": [3, 0, 0]},
        {"name": "eye", "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 6, 1]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "children": [4]},
        {"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}}])");
    json["nodes"][4]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", shifts}, {"ROTATION", turns}}}};
    json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
    json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}},
                                                           {{"type", "directional"}, {"intensity", 683}}};
    json["extensionsUsed"] = {"KHR_lights_punctual", "EXT_mesh_gpu_instancing", "EXT_none"};
    json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return model;
}

} // namespace vkpm
