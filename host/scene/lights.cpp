/// Area lights: flux and probabilities.
#include "scene/lights.h"
#include "scene/box.h"
#include "scene/luminance.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

namespace vkpm {
using glm::dvec3;

dvec3 lightFlux(const Light& light) {
    const double sides = light.twoSided != 0 ? 2 : 1;
    return sides * glm::pi<double>() * double{light.area} * dvec3{light.radiance};
}

void measureEndless(Scene& scene) {
    const double disc = double{scene.lit.radius} * scene.lit.radius;
    for (Light& light : scene.lights)
        if (isEndless(light)) {
            const double solidAngle = glm::pi<double>() * (light.kind == LIGHT_SUN ? 2 * double{light.u.y} : 4.0);
            light.area = static_cast<float>(disc * solidAngle);
        }
}

void chooseLights(Scene& scene, const std::filesystem::path& file) {
    dvec3 flux{0};
    for (const Light& light : scene.lights) flux += lightFlux(light);
    scene.flux = vec3{flux};
    const double total = luminance(flux);
    if (scene.lights.empty() || scene.flux == vec3{0})
        refuseFile(file, ": /shapes", "there is no light",
                   "give a shape an \"emission\", or the scene \"lights\" or an \"environment\", that is not black");
    if (!std::isfinite(scene.flux.x + scene.flux.y + scene.flux.z))
        refuseFile(file, ": /shapes", "the flux of all lights overflows", "lower \"emission\"");

    std::vector<double> fluxes;
    for (const Light& light : scene.lights) fluxes.push_back(luminance(lightFlux(light)));
    scene.lightCdf = cumulative(fluxes);
    for (std::size_t i = 0; i < fluxes.size(); i++) {
        const double probability = double{scene.lightCdf[i]} - (i > 0 ? double{scene.lightCdf[i - 1]} : 0);
        scene.lights[i].share = probability > 0 ? static_cast<float>(fluxes[i] / total / probability) : 1.0f;
    }
}

std::vector<float> cumulative(std::span<const double> weights) {
    const double steps = 0x1p24, total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const auto positive =
        static_cast<std::size_t>(std::ranges::count_if(weights, [](double weight) { return weight > 0; }));
    // A step each beforehand, and the rest in proportion.
    const double each = positive <= std::size_t(1) << 23 ? 1 : 0, rest = steps - each * double(positive);
    std::vector<float> cdf;
    double sum = 0, given = 0;
    for (const double weight : weights) {
        sum += weight;
        if (weight > 0) given += each;
        cdf.push_back(static_cast<float>(std::min(given + std::round(rest * (sum / total)), steps) / steps));
    }
    return cdf;
}

/// About the boxes of primitives that count, `wide` times half the diagonal of them all.
template <class Counts> static Target sphereOf(const Scene& scene, double wide, Counts counts) {
    Bounds box;
    for (std::size_t i = 0; i < scene.primitives.size(); i++) {
        const Primitive& p = scene.primitives[i];
        if (counts(p)) box = united(box, boxOf(p, i >= scene.triangleCount));
    }
    if (box.low.x > box.high.x) return {vec3{0}, 0};
    const dvec3 sides = dvec3{box.high} - dvec3{box.low};
    return {vec3{dvec3{box.low} + 0.5 * sides}, static_cast<float>(0.5 * wide * glm::length(sides))};
}

Target sphereOfLit(const Scene& scene) {
    return sphereOf(scene, 1.000002, [&](const Primitive& p) {
        return p.light == NONE || scene.materials[p.material].kind != MATERIAL_DIFFUSE ||
               scene.materials[p.material].color != vec3{0};
    });
}

Target sphereOfNear(const Scene& scene) {
    return sphereOf(scene, 1.001,
                    [&](const Primitive& p) { return p.light == NONE || !isFar(scene, scene.lights[p.light]); });
}

/// The distance from a place within which boxes lie, where it jumps, from the third part of them on; 0 if it does not.
static double reachOfMost(const std::vector<Bounds>& boxes, dvec3 center) {
    const double jump = 8;
    std::vector<double> reaches;
    for (const Bounds& box : boxes)
        reaches.push_back(glm::length(glm::max(glm::abs(dvec3{box.low} - center), glm::abs(dvec3{box.high} - center))));
    std::ranges::sort(reaches);
    for (std::size_t i = (reaches.size() + 2) / 3; i < reaches.size(); i++)
        if (reaches[i] > jump * reaches[i - 1]) return reaches[i - 1];
    return 0;
}

void findMiddle(Scene& scene) {
    std::vector<Bounds> boxes;
    if (std::ranges::none_of(scene.lights, isEndless)) return;
    for (std::size_t i = 0; i < scene.primitives.size(); i++)
        if (const Primitive& p = scene.primitives[i]; p.light == NONE || scene.materials[p.material].color != vec3{0})
            boxes.push_back(boxOf(p, i >= scene.triangleCount));
    if (boxes.size() < 3) return;
    dvec3 center{0};
    for (int axis = 0; axis < 3; axis++) {
        std::vector<double> middles;
        for (const Bounds& box : boxes) middles.push_back(0.5 * (double{box.low[axis]} + double{box.high[axis]}));
        const auto middle = middles.begin() + std::ptrdiff_t(middles.size() / 2);
        std::ranges::nth_element(middles, middle);
        center[axis] = *middle;
    }
    const double room = 2, radius = room * reachOfMost(boxes, center);
    if (radius == 0) return;
    scene.middle = {vec3{center}, static_cast<float>(radius)};
    for (double wide = radius; wide < double{scene.lit.radius}; wide *= 4) scene.discCount++;
}

bool isFar(const Scene& scene, const Light& light) {
    if (isEndless(light)) return false;
    const dvec3 a = dvec3{light.a} - dvec3{scene.lit.center}, u{light.u}, v{light.v};
    const double reach =
        isDelta(light) ? glm::length(a)
        : light.kind == LIGHT_SPHERE
            ? glm::length(a) + u.x
            : std::max({glm::length(a), glm::length(a + u), glm::length(a + v), glm::length(a + u + v)});
    return reach > 1.9999 * double{scene.lit.radius};
}

} // namespace vkpm
