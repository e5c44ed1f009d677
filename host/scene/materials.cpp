/// Materials of a scene file.
#include "scene/materials.h"
#include "scene/media.h"
#include "scene/rest.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
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

Material readDiffuse(Reader& reader, Scene&) { return {MATERIAL_DIFFUSE, reader.at("albedo").color(fraction), 1}; }

Material readMirror(Reader& reader, Scene&) { return {MATERIAL_MIRROR, reader.at("reflectance").color(fraction), 1}; }

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

/// What light loses on its way (Beer's law), as powers of two over the unit of length of the scene file.
vec3 readAttenuation(Reader reader) {
    const vec3 color = reader.at("color").color(fraction);
    const double distance{reader.at("distance").number(positive)};
    reader.finish();
    vec3 powers{0};
    for (int i = 0; i < 3; ++i)
        powers[i] = static_cast<float>(
            std::min(-std::log2(double{color[i]}) / distance, double{std::numeric_limits<float>::max()}));
    return glm::max(powers, vec3{0});
}

/// What is added to an index for red and for blue, by Abbe's number: they differ by (index - 1) / number.
vec2 readSpread(const Reader& abbe, float ior) {
    const float half = (ior - 1) / (2 * abbe.number({1, std::numeric_limits<float>::max()}));
    return {-half, half};
}

void refuseInside(Reader& glass) {
    for (const char* key : {"attenuation", "abbe", "priority"})
        if (const auto reader = glass.find(key))
            reader->fail("found beside \"thin\"", "allowed is glass with an inside: leave out one of them");
}

/// Glass without a difference of indices has no rough surface either.
Material readGlass(Reader& reader, Scene& scene) {
    Material material{MATERIAL_GLASS, vec3{1}, readIor(reader)};
    if (const auto tint = reader.find("tint")) material.color = tint->color(fraction);
    material.alpha = readAlpha(reader, 0);
    material.rest = NONE;
    const auto thin = reader.find("thin");
    const bool isThin = thin && thin->boolean(), isRough = material.alpha >= smoothestAlpha;
    if (isThin) refuseInside(reader);
    if (isThin) material.kind = isRough ? MATERIAL_ROUGH_THIN_GLASS : MATERIAL_THIN_GLASS;
    else if (isRough && std::abs(material.ior - 1) >= 1e-4f) material.kind = MATERIAL_ROUGH_GLASS;
    if (isThin) return material;

    Medium medium{vec3{0}, reader.at("ior").number(positive)};
    if (const auto attenuation = reader.find("attenuation")) medium.attenuation = readAttenuation(*attenuation);
    if (const auto abbe = reader.find("abbe")) medium.spread = readSpread(*abbe, medium.ior);
    if (const auto priority = reader.find("priority")) medium.priority = priority->integer(0, maxPriority);
    const auto exterior = reader.find("exteriorIor");
    fillGlass(scene, material, medium, exterior ? exterior->number(positive) : 1.0f);
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

Material readMetal(Reader& reader, Scene& scene) {
    const vec3 reflectance = readReflectance(reader);
    const float alpha = readAlpha(reader, 0);
    const auto multiscatter = reader.find("multiscatter");
    const bool scattersMore = !multiscatter || multiscatter->boolean();
    if (alpha < smoothestAlpha) return {MATERIAL_POLISHED, reflectance, 1};
    return {MATERIAL_METAL, reflectance, 1, 0, alpha, scattersMore ? rowOf(scene.rests, alpha, 1) : NONE};
}

Material readPlastic(Reader& reader, Scene& scene) {
    const vec3 albedo = reader.at("albedo").color(fraction);
    const auto ior = reader.find("ior");
    const float index = ior ? ior->number({1, 1000}) : 1.5f, alpha = std::max(smoothestAlpha, readAlpha(reader, 0.3f));
    const double r = (double{index} - 1) / (double{index} + 1);
    return {MATERIAL_PLASTIC, albedo, index, 0, alpha, rowOf(scene.rests, alpha, r * r)};
}

struct MaterialType {
    std::string_view name;
    Material (*read)(Reader&, Scene& scene);
};

/// What "type" may be.
const std::vector<MaterialType> materialTypes{{"diffuse", readDiffuse},
                                              {"mirror", readMirror},
                                              {"glass", readGlass},
                                              {"metal", readMetal},
                                              {"plastic", readPlastic}};

} // namespace

Material readMaterial(Reader reader, Scene& scene) {
    std::vector<std::string_view> names;
    for (const MaterialType& type : materialTypes) names.push_back(type.name);
    const Material material = materialTypes[reader.at("type").choice(names)].read(reader, scene);
    reader.finish();
    return material;
}

} // namespace vkpm
