/// The map from glTF's materials to those of scenes.
#include "scene/gltf_material.h"
#include <fmt/format.h>

namespace vkpm {
using nlohmann::json;

namespace {

/// A number of an object that may be absent, key and all.
float numberOr(std::optional<Reader>& object, std::string_view key, float otherwise, Range range) {
    const auto reader = object ? object->find(key) : std::nullopt;
    return reader ? reader->number(range) : otherwise;
}

vec3 colorOr(std::optional<Reader>& object, std::string_view key, Range range) {
    const auto reader = object ? object->find(key) : std::nullopt;
    return reader ? reader->vector(range) : vec3{1};
}

json listOf(const vec3& color) { return {color.x, color.y, color.z}; }

/// The parts of a material that matter here, read and checked.
class GltfSurface {
public:
    GltfSurface(Reader from, Losses& lost) : material{std::move(from)}, losses{lost} {
        extensions = material.find("extensions");
        pbr = material.find("pbrMetallicRoughness");
        if (const auto color = pbr ? pbr->find("baseColorFactor") : std::nullopt) base = readBase(*color);
        metallic = numberOr(pbr, "metallicFactor", 1, fraction);
        roughness = numberOr(pbr, "roughnessFactor", 1, fraction);
        auto transmissionOf = extension("KHR_materials_transmission"), iorOf = extension("KHR_materials_ior"),
             volume = extension("KHR_materials_volume");
        transmission = numberOr(transmissionOf, "transmissionFactor", 0, fraction);
        ior = numberOr(iorOf, "ior", 1.5f, notNegative);
        thickness = numberOr(volume, "thicknessFactor", 0, notNegative);
        attenuates = thickness > 0 && colorOr(volume, "attenuationColor", fraction) != vec3{1};
        readSpecularGlossiness();
        noteLosses();
    }

    vec3 readEmission() {
        const auto factor = material.find("emissiveFactor");
        auto strength = extension("KHR_materials_emissive_strength");
        const float scale = numberOr(strength, "emissiveStrength", 1, notNegative);
        const vec3 radiance = factor ? scale * factor->vector(fraction) : vec3{0};
        if (radiance != vec3{0} && material.find("emissiveTexture")) {
            lose("a texture that says where a surface emits cannot be read: the surface emits nothing");
            return vec3{0};
        }
        if (!(radiance.x + radiance.y + radiance.z < std::numeric_limits<float>::infinity()))
            material.fail("what is emitted is beyond the range of 32-bit floats", "allowed are finite products");
        return radiance;
    }

    json opaque() {
        if (metallic < 0.5f) {
            if (roughness < 1) lose("the gloss of a surface that is no metal is left out: it is diffuse");
            return {{"type", "diffuse"}, {"albedo", listOf(base)}};
        }
        const bool isMirror = roughness <= 0.3f;
        if (isMirror && roughness > 0) lose("a metal of roughness 0.3 or less is a mirror");
        if (!isMirror && metallicIsGiven()) lose("a metal of a roughness above 0.3 is diffuse");
        if (isMirror) return {{"type", "mirror"}, {"reflectance", listOf(base)}};
        return {{"type", "diffuse"}, {"albedo", listOf(base)}};
    }

    json transparent(GltfGlass glass) {
        if (roughness > 0) lose("the roughness of glass is left out: it is smooth");
        if (attenuates) lose("what glass absorbs on the way through is left out");
        const bool isThin = glass == GltfGlass::thin && thickness == 0;
        if (isThin) lose("thin glass lets light straight through, and reflects none");
        else if (thickness == 0 && glass == GltfGlass::automatic)
            lose("glass without a thickness (KHR_materials_volume) is taken for solid; \"glass\": \"thin\" of "
                 "\"import\" "
                 "takes it for panes");
        if (!(ior >= 1e-3f && ior <= 1e3f)) lose("an index of refraction beyond 0.001 to 1000 becomes 1.5"), ior = 1.5f;
        return {{"type", "glass"}, {"ior", isThin ? 1.0f : ior}, {"tint", listOf(base)}};
    }

    bool isTwoSided() {
        const auto twoSided = material.find("doubleSided");
        return twoSided && twoSided->boolean();
    }
    bool isGlass() const { return transmission >= 0.5f && metallic < 0.5f; }

private:
    std::optional<Reader> extension(std::string_view name) {
        return extensions ? extensions->find(name) : std::nullopt;
    }
    void lose(std::string_view what) { losses.add(material, what); }
    bool metallicIsGiven() { return pbr && pbr->find("metallicFactor"); }

    /// The model of before 2021: what it says of gloss is lost.
    void readSpecularGlossiness() {
        auto older = extension("KHR_materials_pbrSpecularGlossiness");
        if (!older) return;
        lose("of KHR_materials_pbrSpecularGlossiness only the diffuse colour is taken");
        metallic = 0;
        if (const auto color = older->find("diffuseFactor")) base = readBase(*color);
        if (older->find("diffuseTexture")) noteColorTexture();
    }

    vec3 readBase(const Reader& color) const {
        const std::vector<Reader> parts = color.elements(4, 4, "an array of 4 numbers, [red, green, blue, opacity]");
        return {parts[0].number(fraction), parts[1].number(fraction), parts[2].number(fraction)};
    }

    void noteColorTexture() {
        lose("a texture of colour cannot be read: the surface is half as bright as its factor says");
        base *= 0.5f;
    }

    void noteLosses() {
        if (pbr && pbr->find("baseColorTexture")) noteColorTexture();
        if (pbr && pbr->find("metallicRoughnessTexture")) lose("a texture of metal and roughness is left out");
        if (material.find("normalTexture")) lose("a normal map is left out");
        const auto alpha = material.find("alphaMode");
        if (alpha && alpha->choice({"OPAQUE", "MASK", "BLEND"}) > 0)
            lose("opacity is left out: what is see-through there is opaque");
        if (transmission > 0 && transmission < 0.5f) lose("a transmission below 0.5 is left out");
        for (const char* name : {"anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "iridescence",
                                 "sheen", "specular", "unlit"})
            if (extension(fmt::format("KHR_materials_{}", name)))
                lose(fmt::format("KHR_materials_{} is left out", name));
    }

    Reader material;
    Losses& losses;
    std::optional<Reader> extensions, pbr;
    vec3 base{1};
    float metallic = 1, roughness = 1, transmission = 0, ior = 1.5f, thickness = 0;
    bool attenuates = false;
};

} // namespace

GltfMaterial readGltfMaterial(Reader material, GltfGlass glass, Losses& losses) {
    GltfSurface surface(std::move(material), losses);
    GltfMaterial result{.radiance = surface.readEmission(), .twoSided = surface.isTwoSided()};
    const bool emits = result.radiance != vec3{0}; // only diffuse shapes may
    result.material = surface.isGlass() && !emits ? surface.transparent(glass) : surface.opaque();
    if (emits && result.material["type"] == "mirror")
        result.material = {{"type", "diffuse"}, {"albedo", result.material["reflectance"]}};
    return result;
}

GltfMaterial defaultGltfMaterial() { return {.material = {{"type", "diffuse"}, {"albedo", 1}}}; }

} // namespace vkpm
