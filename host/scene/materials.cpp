/// Materials of a scene file.
#include "scene/materials.h"
#include "scene/rest.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace vkpm {
namespace {

/// Index inside over index outside.
float readIor(Reader& glass) {
    const Reader iorReader = glass.at("ior");
    const float inside = iorReader.number(positive);
    const auto exterior = glass.find("exteriorIor");
    const float ratio = inside / (exterior ? exterior->number(positive) : 1.0f);
    if (!(ratio >= 1e-3f && ratio <= 1e3f))
        iorReader.fail(fmt::format("found {} times the index outside", ratio), "allowed is a ratio from 0.001 to 1000");
    return ratio;
}

Material readDiffuse(Reader& reader, std::vector<float>&) {
    return {MATERIAL_DIFFUSE, reader.at("albedo").color(fraction), 1};
}

Material readMirror(Reader& reader, std::vector<float>&) {
    return {MATERIAL_MIRROR, reader.at("reflectance").color(fraction), 1};
}

/// Widths of lobes below this are those of a mirror: in 32-bit floats, nothing is left of the density of facets.
constexpr float smooth = 1e-3f;

float numberOr(Reader& reader, std::string_view key, float otherwise, Range range) {
    const auto number = reader.find(key);
    return number ? number->number(range) : otherwise;
}

float readAlpha(Reader& reader, float otherwise) {
    const float r = numberOr(reader, "roughness", otherwise, fraction);
    return r * r;
}

/// Glass without a difference of indices has no rough surface either.
Material glassOf(vec3 tint, float ior, float roughness) {
    Material material{MATERIAL_GLASS, tint, ior, 0, roughness * roughness, NONE};
    if (material.alpha >= smooth && std::abs(ior - 1) >= 1e-4f) material.kind = MATERIAL_ROUGH_GLASS;
    return material;
}

Material readGlass(Reader& reader, std::vector<float>&) {
    const float ior = readIor(reader);
    const auto tint = reader.find("tint");
    return glassOf(tint ? tint->color(fraction) : vec3{1}, ior, numberOr(reader, "roughness", 0, fraction));
}

struct Metal {
    std::string_view name;
    vec3 reflectance; // at normal incidence, linear Rec. 709
};
/// Hoffman, Physics and math of shading, SIGGRAPH 2012.
const std::vector<Metal> metals{{"gold", {1.000f, 0.766f, 0.336f}},   {"silver", {0.972f, 0.960f, 0.915f}},
                                {"copper", {0.955f, 0.637f, 0.538f}}, {"aluminium", {0.913f, 0.921f, 0.925f}},
                                {"iron", {0.560f, 0.570f, 0.580f}},   {"chromium", {0.549f, 0.556f, 0.554f}}};

vec3 readReflectance(Reader& reader) {
    const auto preset = reader.find("preset");
    const auto reflectance = reader.find("reflectance");
    if (preset && reflectance) preset->fail("found both \"preset\" and \"reflectance\"", "give one of them");
    if (!preset) return (reflectance ? *reflectance : reader.at("reflectance")).color(fraction);
    std::vector<std::string_view> names;
    for (const Metal& metal : metals) names.push_back(metal.name);
    return metals[preset->choice(names)].reflectance;
}

Material readMetal(Reader& reader, std::vector<float>& rests) {
    const vec3 reflectance = readReflectance(reader);
    const float alpha = readAlpha(reader, 0);
    const auto multiscatter = reader.find("multiscatter");
    const bool scattersMore = !multiscatter || multiscatter->boolean();
    if (alpha < smooth) return {MATERIAL_POLISHED, reflectance, 1};
    return {
        MATERIAL_METAL, reflectance, 1, 0, alpha, scattersMore ? placeRows(rests, restRow(double{alpha}, 1)) : NONE};
}

Material readPlastic(Reader& reader, std::vector<float>& rests) {
    const vec3 albedo = reader.at("albedo").color(fraction);
    const auto ior = reader.find("ior");
    const float index = ior ? ior->number({1, 1000}) : 1.5f, alpha = std::max(smooth, readAlpha(reader, 0.3f));
    const double r = (double{index} - 1) / (double{index} + 1);
    return {MATERIAL_PLASTIC, albedo, index, 0, alpha, placeRows(rests, restRow(double{alpha}, r * r))};
}

/// glTF's metallic-roughness model with its defaults, with KHR_materials_ior, _specular and _transmission.
Material readStandard(Reader& reader, std::vector<float>& rests) {
    const auto color = reader.find("baseColor"), specularColor = reader.find("specularColor"),
               transmissionReader = reader.find("transmission");
    Material material{MATERIAL_STANDARD, color ? color->color(fraction) : vec3{1}};
    material.metallic = numberOr(reader, "metallic", 1, fraction);
    const float roughness = numberOr(reader, "roughness", 1, fraction);
    material.ior = numberOr(reader, "ior", 1.5f, {0, 1000});
    material.grazing = numberOr(reader, "specular", 1, fraction);
    const float r = (material.ior - 1) / (material.ior + 1);
    const vec3 specular = specularColor ? specularColor->color(notNegative) : vec3{1};
    material.normalIncidence = glm::min(r * r * specular, vec3{1}) * material.grazing;

    const float transmission = transmissionReader ? transmissionReader->number(fraction) : 0;
    if (transmission > 0 && (transmission < 1 || material.metallic > 0))
        transmissionReader->fail(
            fmt::format("found {} of a material whose \"metallic\" is {}", transmission, material.metallic),
            "allowed is 0, or 1 where \"metallic\" is 0");
    if (transmission > 0) return glassOf(material.color, std::max(material.ior, 1e-3f), roughness);
    if (material.grazing == 0 && material.metallic == 0) return {MATERIAL_DIFFUSE, material.color, 1};
    material.alpha = std::max(smooth, roughness * roughness);
    material.rest = placeRows(rests, standardRows(double{material.alpha}));
    return material;
}

struct MaterialType {
    std::string_view name;
    Material (*read)(Reader&, std::vector<float>& rests);
};

/// What "type" may be.
const std::vector<MaterialType> materialTypes{{"diffuse", readDiffuse}, {"mirror", readMirror},
                                              {"glass", readGlass},     {"metal", readMetal},
                                              {"plastic", readPlastic}, {"standard", readStandard}};

} // namespace

Material readMaterial(Reader reader, std::vector<float>& rests) {
    std::vector<std::string_view> names;
    for (const MaterialType& type : materialTypes) names.push_back(type.name);
    const Material material = materialTypes[reader.at("type").choice(names)].read(reader, rests);
    reader.finish();
    return material;
}

} // namespace vkpm
