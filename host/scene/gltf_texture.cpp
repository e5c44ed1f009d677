/// Texture infos, samplers and images of glTF (2.0, section 3.8), with KHR_texture_transform.
#include "scene/gltf_texture.h"
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
using nlohmann::json;

namespace {

enum : uint { NEAREST = 9728, CLAMP = 33071, MIRRORED = 33648 };

/// glTF's coordinates go down from the upper edge, those of scenes up from the lower one.
json transformOf(Reader transform) {
    glm::dvec2 offset{0}, scale{1};
    if (const auto value = transform.find("offset")) offset = value->pair({-1e5f, 1e5f});
    if (const auto value = transform.find("scale")) scale = value->pair({-1e5f, 1e5f});
    const auto rotation = transform.find("rotation");
    const double angle = rotation ? rotation->precise() : 0, s = std::sin(angle), c = std::cos(angle);
    return {{"scale", {scale.x, scale.y}},
            {"rotation", glm::degrees(angle)},
            {"offset", {offset.x + s * scale.y, 1 - c * scale.y - offset.y}}};
}

} // namespace

std::optional<json> GltfTextures::read(Reader info, bool isColor) {
    Reader texture = file.referenced(info.at("index"), "textures");
    const auto name = imageOf(texture);
    if (!name) return std::nullopt;
    json result{{"texture", *name}, {"space", isColor ? "srgb" : "linear"}};
    auto set = info.find("texCoord");
    if (auto extensions = info.find("extensions"))
        if (auto transform = extensions->find("KHR_texture_transform")) {
            result["transform"] = transformOf(*transform);
            if (const auto other = transform->find("texCoord")) set = other;
        }
    if (set && set->integer(0, 1000) > 1)
        losses.add(info, "a third set of texture coordinates is left out: the second takes its place");
    if (set) result["uv"] = std::min(set->integer(0, 1000), 1u);
    const auto samplerIndex = texture.find("sampler");
    if (!samplerIndex) return result;
    Reader sampler = file.referenced(*samplerIndex, "samplers");
    const auto wrap = [&](const char* key) {
        const auto mode = sampler.find(key);
        const uint number = mode ? mode->integer(0, NONE) : 0;
        return number == CLAMP ? "clamp" : number == MIRRORED ? "mirror" : "repeat";
    };
    result["wrap"] = {wrap("wrapS"), wrap("wrapT")};
    const auto filter = sampler.find("magFilter");
    if (filter && filter->integer(0, NONE) == NEAREST) result["filter"] = "nearest";
    return result;
}

std::optional<json> GltfTextures::roughnessOfGloss(const Reader& info, float gloss) {
    auto texture = read(info, false);
    if (texture) (*texture)["texture"] = textures.giveRoughness(info, (*texture)["texture"], gloss);
    return texture;
}

/// The name by which textures know the image.
std::optional<std::string> GltfTextures::imageOf(Reader& texture) {
    const auto source = texture.find("source");
    if (!source) {
        losses.add(texture, "textures whose images are neither PNG nor JPEG (KTX2, WebP) are left out; `npx "
                            "@gltf-transform/cli png in.glb out.glb` converts them");
        return std::nullopt;
    }
    Reader image = file.referenced(*source, "images");
    const std::string name = fmt::format("{}: /images/{}", file.name().string(), source->integer(0, NONE));
    if (!textures.knows(name)) textures.give(name, file.image(image));
    return name;
}

} // namespace vkpm
