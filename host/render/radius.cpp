/// First radii from areas and photon counts.
#include "render/radius.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vkpm {

// Photons emitted per area of a disc. Photons of the global map are only seen through a gather ray, so noise of a few
// photons each averages out; caustics are looked at directly.
const double globalPhotonsPerDisc = 1.5;
const double causticPhotonsPerDisc = 20;

// The search radius for the k nearest holds more than k almost everywhere.
const double nearestMargin = 8;

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

static double targetArea(const Scene& scene) {
    double area = 0;
    for (const Target& target : scene.targets) area += std::numbers::pi * target.radius * target.radius;
    return area;
}

// At most a fiftieth of the scene, so that few photons still make a picture of discs.
static float chooseRadius(const Scene& scene, double area, double perDisc, uint photons, uint nearest) {
    const double wanted = nearest ? nearestMargin * nearest : perDisc;
    const double most = (nearest ? 0.2 : 0.02) * glm::length(glm::dvec3(scene.bounds.high - scene.bounds.low));
    return static_cast<float>(std::min(most, std::sqrt(wanted * area / (std::numbers::pi * std::max(photons, 1u)))));
}

Settings chooseRadii(const Scene& scene, Settings settings) {
    if (!settings.radius)
        settings.radius = chooseRadius(scene, surfaceArea(scene), globalPhotonsPerDisc, settings.photons, settings.nearest);
    if (!settings.causticRadius)
        settings.causticRadius = chooseRadius(scene, targetArea(scene), causticPhotonsPerDisc, settings.causticPhotons, settings.nearest);
    return settings;
}

float radiusFactor(uint pass, float alpha) {
    // Gamma(n + a) / (Gamma(n + 1) Gamma(1 + a)), n = pass + 1; the logarithms of large n cancel to 1e-9 in 64 bits of mantissa.
    const long double n = pass + 1.0L;
    const long double a = alpha;
    return float(std::exp((std::lgamma(n + a) - std::lgamma(n + 1) - std::lgamma(1 + a)) / 2));
}

} // namespace vkpm
