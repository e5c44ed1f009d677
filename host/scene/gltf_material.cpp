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
    GltfSurface(Reader from, GltfTextures images, Losses& lost)
        : material{std::move(from)}, textures{images}, losses{lost} {
        extensions = material.find("extensions");
        pbr = material.find("pbrMetallicRoughness");
        if (const auto color = pbr ? pbr->find("baseColorFactor") : std::nullopt) base = readBase(*color);
        metallic = numberOr(pbr, "metallicFactor", 1, fraction);
        roughness = numberOr(pbr, "roughnessFactor", 1, fraction);
        auto transmissionOf = extension("KHR_materials_transmission"), iorOf = extension("KHR_materials_ior"),
             volume = extension("KHR_materials_volume");
        transmission = numberOr(transmissionOf, "transmissionFactor", 0, fraction);
        transmissionTexture = textureOf(transmissionOf, "transmissionTexture", false);
        ior = numberOr(iorOf, "ior", 1.5f, {0, 1000});
        auto specularOf = extension("KHR_materials_specular");
        specular = numberOr(specularOf, "specularFactor", 1, fraction);
        specularColor = colorOr(specularOf, "specularColorFactor", notNegative);
        specularTexture = textureOf(specularOf, "specularTexture", false);
        specularColorTexture = textureOf(specularOf, "specularColorTexture", true);
        thickness = numberOr(volume, "thicknessFactor", 0, notNegative);
        attenuationColor = colorOr(volume, "attenuationColor", fraction);
        attenuationDistance = numberOr(volume, "attenuationDistance", 0, positive);
        auto dispersionOf = extension("KHR_materials_dispersion");
        dispersion = numberOr(dispersionOf, "dispersion", 0, notNegative);
        baseTexture = textureOf(pbr, "baseColorTexture", true);
        roughnessTexture = textureOf(pbr, "metallicRoughnessTexture", false);
        readSpecularGlossiness();
        readOpacity();
        noteLosses();
    }

    vec3 readEmission() {
        const auto factor = material.find("emissiveFactor");
        auto strength = extension("KHR_materials_emissive_strength");
        const float scale = numberOr(strength, "emissiveStrength", 1, notNegative);
        const vec3 radiance = factor ? scale * factor->vector(fraction) : vec3{0};
        if (!(radiance.x + radiance.y + radiance.z < std::numeric_limits<float>::infinity()))
            material.fail("what is emitted is beyond the range of 32-bit floats", "allowed are finite products");
        return radiance;
    }

    /// What it emits as a texture; null without one.
    json emissionTexture(const vec3& radiance) {
        const auto info = material.find("emissiveTexture");
        if (radiance == vec3{0} || !info) return nullptr;
        auto texture = textures.read(*info, true);
        if (!texture) return nullptr;
        (*texture)["factor"] = listOf(radiance);
        return *texture;
    }

    json opaque() {
        json result{{"type", "standard"},
                    {"baseColor", withFactor(baseTexture, listOf(base))},
                    {"metallic", metallic > 0 ? withFactor(roughnessTexture, metallic) : json(0)},
                    {"roughness", withFactor(roughnessTexture, roughness)}};
        if (ior != 1.5f) result["ior"] = ior;
        if (specular != 1 || specularTexture) result["specular"] = withFactor(specularTexture, specular);
        if (specularColor != vec3{1} || specularColorTexture)
            result["specularColor"] = withFactor(specularColorTexture, listOf(specularColor));
        return result;
    }

    /// Glass, or a material that transmits a part.
    json transparent(GltfGlass glass) {
        const bool isThin = glass == GltfGlass::thin && thickness == 0;
        if (!isThin && thickness == 0 && glass == GltfGlass::automatic)
            lose("glass without a thickness (KHR_materials_volume) is taken for solid; \"glass\": \"thin\" of "
                 "\"import\" "
                 "takes it for panes");
        if (!(ior >= 1e-3f && ior <= 1e3f)) lose("an index of refraction beyond 0.001 to 1000 becomes 1.5"), ior = 1.5f;
        if (transmission < 1 || transmissionTexture || metallic > 0) {
            json result = opaque();
            result["transmission"] = withFactor(transmissionTexture, transmission);
            fill(result, isThin);
            return result;
        }
        if (specular != 1 || specularTexture || specularColor != vec3{1} || specularColorTexture)
            lose("KHR_materials_specular of glass is left out");
        json result{{"type", "glass"}, {"ior", ior}, {"tint", listOf(base)}};
        if (baseTexture) // of which a standard material may be made
            result = {{"type", "standard"},
                      {"metallic", 0},
                      {"transmission", 1},
                      {"ior", ior},
                      {"baseColor", withFactor(baseTexture, listOf(base))}};
        result["roughness"] = withFactor(roughnessTexture, roughness);
        fill(result, isThin);
        if (result["type"] == "glass" && roughnessTexture) result["roughness"]["channel"] = "g";
        return result;
    }

    /// Adds what glass is filled with, or that it is thin.
    void fill(json& glass, bool isThin) const {
        if (isThin) glass["thin"] = true;
        if (thickness > 0 && attenuationDistance > 0 && attenuationColor != vec3{1})
            glass["attenuation"] = {{"color", listOf(attenuationColor)}, {"distance", attenuationDistance}};
        if (thickness > 0 && dispersion > 0) glass["abbe"] = std::max(1.0f, 20 / dispersion);
    }

    /// Adds what the material stops of what meets it.
    void addOpacity(json& to) {
        if (!opacity.is_null()) to["opacity"] = opacity;
        if (cutoff) to["cutoff"] = *cutoff;
    }
    void addNormalMap(json& to) {
        auto info = material.find("normalTexture");
        auto texture = info ? textures.read(*info, false) : std::nullopt;
        if (!texture) return;
        texture->erase("space");
        (*texture)["strength"] = numberOr(info, "scale", 1, {-1000, 1000});
        to["normalMap"] = *texture;
    }

    bool isTwoSided() {
        const auto twoSided = material.find("doubleSided");
        return twoSided && twoSided->boolean();
    }
    bool transmits() const { return transmission > 0 && (metallic < 1 || roughnessTexture); }

private:
    std::optional<Reader> extension(std::string_view name) {
        return extensions ? extensions->find(name) : std::nullopt;
    }
    void lose(std::string_view what) { losses.add(material, what); }
    std::optional<json> textureOf(std::optional<Reader>& object, std::string_view key, bool isColor) {
        const auto info = object ? object->find(key) : std::nullopt;
        return info ? textures.read(*info, isColor) : std::nullopt;
    }

    /// The model of before 2021. An index of 0 stands for a reflectance that its colour says alone (KHR_materials_ior).
    void readSpecularGlossiness() {
        auto older = extension("KHR_materials_pbrSpecularGlossiness");
        if (!older) return;
        base = vec3{1}; // in place of what the newer model says
        alpha = 1;
        baseTexture = roughnessTexture = std::nullopt;
        metallic = ior = 0;
        roughness = 1 - numberOr(older, "glossinessFactor", 1, fraction);
        specularColor = colorOr(older, "specularFactor", fraction);
        if (const auto color = older->find("diffuseFactor")) base = readBase(*color);
        if (const auto info = older->find("diffuseTexture")) baseTexture = textures.read(*info, true);
        specularColorTexture = textureOf(older, "specularGlossinessTexture", true);
        if (const auto info = older->find("specularGlossinessTexture"); info && roughness < 1) {
            roughnessTexture = textures.roughnessOfGloss(*info, 1 - roughness);
            roughness = 1;
        }
    }

    vec3 readBase(const Reader& color) {
        const std::vector<Reader> parts = color.elements(4, 4, "an array of 4 numbers, [red, green, blue, opacity]");
        alpha = parts[3].number(fraction);
        return {parts[0].number(fraction), parts[1].number(fraction), parts[2].number(fraction)};
    }

    static json withFactor(const std::optional<json>& texture, json factor) {
        if (!texture) return factor;
        json result = *texture;
        result["factor"] = std::move(factor);
        return result;
    }

    void readOpacity() {
        const auto mode = material.find("alphaMode"), threshold = material.find("alphaCutoff");
        const std::size_t kind = mode ? mode->choice({"OPAQUE", "MASK", "BLEND"}) : 0;
        if (kind == 0 || (kind == 2 && !baseTexture && alpha == 1)) return;
        opacity = withFactor(baseTexture, alpha);
        if (baseTexture) opacity["channel"] = "a";
        if (kind == 1) cutoff = threshold ? threshold->number(notNegative) : 0.5f;
        if (cutoff > 1.0f) { // nothing is as opaque
            opacity = 0;
            cutoff.reset();
        }
    }

    void noteLosses() {
        if (auto volume = extension("KHR_materials_volume"); volume && volume->find("thicknessTexture"))
            lose("\"thicknessTexture\" is left out: glass is as thick as its mesh");
        for (const char* name : {"anisotropy", "clearcoat", "diffuse_transmission", "iridescence", "sheen", "unlit"})
            if (extension(fmt::format("KHR_materials_{}", name)))
                lose(fmt::format("KHR_materials_{} is left out", name));
    }

    Reader material;
    GltfTextures textures;
    Losses& losses;
    std::optional<json> baseTexture, roughnessTexture, transmissionTexture, specularTexture, specularColorTexture;
    json opacity;
    std::optional<float> cutoff;
    float alpha = 1;
    std::optional<Reader> extensions, pbr;
    vec3 base{1};
    vec3 specularColor{1};
    float metallic = 1, roughness = 1, transmission = 0, ior = 1.5f, thickness = 0, specular = 1;
    vec3 attenuationColor{1};
    float attenuationDistance = 0, dispersion = 0;
};

} // namespace

GltfMaterial readGltfMaterial(Reader material, GltfGlass glass, GltfTextures textures, Losses& losses) {
    GltfSurface surface(std::move(material), textures, losses);
    GltfMaterial result{.radiance = surface.readEmission(), .twoSided = surface.isTwoSided()};
    result.emission = surface.emissionTexture(result.radiance);
    result.material = surface.transmits() ? surface.transparent(glass) : surface.opaque();
    surface.addNormalMap(result.material);
    surface.addOpacity(result.material);
    return result;
}

GltfMaterial defaultGltfMaterial() { return {.material = {{"type", "standard"}}}; }

} // namespace vkpm
