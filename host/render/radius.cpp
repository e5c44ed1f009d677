/// Radii by the size of the scene and by the pass.
#include "render/radius.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vkpm {

static double surfaceArea(const Scene& scene) {
    double area = 0;
    for (std::size_t i = 0; i < scene.primitives.size(); i++) {
        const Primitive& p = scene.primitives[i];
        const double radius = p.b.x;
        if (i < scene.triangleCount) area += 0.5 * glm::length(glm::cross(glm::dvec3(p.b - p.a), glm::dvec3(p.c - p.a)));
        else area += 4 * std::numbers::pi * radius * radius;
    }
    return area;
}

float widestRadius(const Scene& scene, uint photons, uint nearest) {
    const double diagonal = glm::length(glm::dvec3(scene.bounds.high) - glm::dvec3(scene.bounds.low));
    const double many = 200'000;
    if (nearest == 0) return static_cast<float>(0.02 * diagonal * std::sqrt(many / std::max<double>(photons, many)));
    const double wanted = 8.0 * nearest; // more than k photons almost everywhere
    return static_cast<float>(std::min(0.2 * diagonal, std::sqrt(wanted * surfaceArea(scene) / (std::numbers::pi * std::max(photons, 1u)))));
}

uint mostLevels(const Scene& scene, float radius) {
    const vec3 reach = glm::max(glm::abs(scene.bounds.low), glm::abs(scene.bounds.high));
    const double cells = std::max({reach.x, reach.y, reach.z}) / (2.1 * radius);
    uint levels = MOST_LEVELS;
    while (levels > 0 && std::ldexp(cells, static_cast<int>(levels)) > 0x1p18) levels--;
    return levels;
}

float radiusFactor(uint pass, float alpha) {
    // Gamma(n + a) / (Gamma(n + 1) Gamma(1 + a)), n = pass + 1; the logarithms of large n cancel to 1e-9 in 64 bits of mantissa.
    const long double n = pass + 1.0L;
    const long double a = alpha;
    return float(std::exp((std::lgamma(n + a) - std::lgamma(n + 1) - std::lgamma(1 + a)) / 2));
}

} // namespace vkpm
