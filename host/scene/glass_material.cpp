/// Glass of a scene file: what it is filled with.
#include "scene/glass_material.h"
#include "scene/media.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace vkpm {
namespace {

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

} // namespace

Material readGlass(Reader& reader, Scene& scene, vec3 tint, float ior, float exteriorIor, float roughness) {
    Material material{MATERIAL_GLASS, tint, ior / exteriorIor, 0, roughness * roughness, NONE};
    const auto thin = reader.find("thin");
    const bool isThin = thin && thin->boolean(), isRough = material.alpha >= LEAST_ALPHA;
    if (isThin) refuseInside(reader);
    if (isThin) material.kind = isRough ? MATERIAL_ROUGH_THIN_GLASS : MATERIAL_THIN_GLASS;
    // Without a difference of indices there is no rough surface either.
    else if (isRough && std::abs(material.ior - 1) >= 1e-4f) material.kind = MATERIAL_ROUGH_GLASS;
    if (isThin) return material;

    Medium medium{vec3{0}, ior};
    if (const auto attenuation = reader.find("attenuation")) medium.attenuation = readAttenuation(*attenuation);
    if (const auto abbe = reader.find("abbe")) medium.spread = readSpread(*abbe, ior);
    if (const auto priority = reader.find("priority")) medium.priority = priority->integer(0, maxPriority);
    fillGlass(scene, material, medium, exteriorIor);
    return material;
}

} // namespace vkpm
