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

float readAlpha(Reader& reader, float otherwise) {
    const auto roughness = reader.find("roughness");
    const float r = roughness ? roughness->number(fraction) : otherwise;
    return r * r;
}

/// The row of a lobe, which is added if there is none like it.
uint rowOf(std::vector<float>& rests, float alpha, double normalIncidence) {
    const std::vector<float> row = restRow(double{alpha}, normalIncidence);
    for (std::size_t i = 0; i < rests.size(); i += REST_ROW)
        if (std::equal(row.begin(), row.end(), rests.begin() + std::ptrdiff_t(i))) return uint(i / REST_ROW);
    rests.insert(rests.end(), row.begin(), row.end());
    return uint(rests.size() / REST_ROW) - 1;
}

/// Glass without a difference of indices has no rough surface either.
Material readGlass(Reader& reader, std::vector<float>&) {
    Material material{MATERIAL_GLASS, vec3{1}, readIor(reader)};
    if (const auto tint = reader.find("tint")) material.color = tint->color(fraction);
    material.alpha = readAlpha(reader, 0);
    material.rest = NONE;
    if (material.alpha >= smooth && std::abs(material.ior - 1) >= 1e-4f) material.kind = MATERIAL_ROUGH_GLASS;
    return material;
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
    return {MATERIAL_METAL, reflectance, 1, 0, alpha, scattersMore ? rowOf(rests, alpha, 1) : NONE};
}

Material readPlastic(Reader& reader, std::vector<float>& rests) {
    const vec3 albedo = reader.at("albedo").color(fraction);
    const auto ior = reader.find("ior");
    const float index = ior ? ior->number({1, 1000}) : 1.5f, alpha = std::max(smooth, readAlpha(reader, 0.3f));
    const double r = (double{index} - 1) / (double{index} + 1);
    return {MATERIAL_PLASTIC, albedo, index, 0, alpha, rowOf(rests, alpha, r * r)};
}

struct MaterialType {
    std::string_view name;
    Material (*read)(Reader&, std::vector<float>& rests);
};

/// What "type" may be.
const std::vector<MaterialType> materialTypes{{"diffuse", readDiffuse},
                                              {"mirror", readMirror},
                                              {"glass", readGlass},
                                              {"metal", readMetal},
                                              {"plastic", readPlastic}};

} // namespace

Material readMaterial(Reader reader, std::vector<float>& rests) {
    std::vector<std::string_view> names;
    for (const MaterialType& type : materialTypes) names.push_back(type.name);
    const Material material = materialTypes[reader.at("type").choice(names)].read(reader, rests);
    reader.finish();
    return material;
}

} // namespace vkpm
