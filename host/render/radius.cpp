/// Radii by the size of the scene and by the pass.
#include "render/radius.h"
#include "scene/box.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace vkpm {

static double surfaceArea(const Scene& scene) {
    double area = 0;
    for (std::size_t i = 0; i < scene.primitives.size(); i++) {
        const Primitive& p = scene.primitives[i];
        const double radius = p.b.x;
        if (i < scene.triangleCount)
            area += 0.5 * glm::length(glm::cross(glm::dvec3(p.b - p.a), glm::dvec3(p.c - p.a)));
        else area += 4 * std::numbers::pi * radius * radius;
    }
    return area;
}

/// The box that holds all but a hundredth of the places at either end of each axis; at least one place.
static Bounds middleOf(std::span<const vec3> places) {
    Bounds box;
    std::vector<float> xs(places.size());
    const auto few = static_cast<std::ptrdiff_t>(places.size() / 100);
    for (int axis = 0; axis < 3; axis++) {
        std::ranges::transform(places, xs.begin(), [&](vec3 place) { return place[axis]; });
        std::ranges::sort(xs);
        box.low[axis] = *(xs.begin() + few);
        box.high[axis] = *(xs.end() - 1 - few);
    }
    return box;
}

static double diagonalOf(const Bounds& box) { return glm::length(glm::dvec3(box.high) - glm::dvec3(box.low)); }

const std::size_t enoughForExtent = 100; // places

Extent extentOf(const Scene& scene) {
    return {diagonalOf(scene.bounds), reachOf(scene.bounds), surfaceArea(scene), scene.coordinates.unit};
}

Extent extentOf(const Extent& whole, std::span<const vec3> places) {
    if (places.size() < enoughForExtent) return whole;
    const Bounds middle = middleOf(places);
    const double room = 2; // for those beyond the middle
    const double diagonal = room * diagonalOf(middle);
    if (diagonal < std::ldexp(reachOf(middle), -10)) return whole; // all but a point
    return {std::min(whole.diagonal, diagonal), std::min(whole.reach, room * reachOf(middle)),
            std::min(whole.area, 2 * diagonal * diagonal), whole.unit};
}

float widestRadius(const Extent& extent, uint photons, uint nearest) {
    const double many = 200'000;
    if (nearest == 0)
        return static_cast<float>(0.02 * extent.diagonal * std::sqrt(many / std::max<double>(photons, many)));
    const double wanted = 8.0 * nearest; // more than k photons almost everywhere
    return static_cast<float>(
        std::min(0.2 * extent.diagonal, std::sqrt(wanted * extent.area / (std::numbers::pi * std::max(photons, 1u)))));
}

static double minRadius(const Extent& extent) { return std::ldexp(extent.reach, -18); } // 64 roundings

bool drownsInRounding(const Extent& extent, float radius) { return radius < minRadius(extent); }

void requireRadius(const Extent& extent, float radius, std::string_view name) {
    if (drownsInRounding(extent, radius))
        throw InputError(fmt::format("{}: found {:.3g}; allowed: at least {:.3g}, since the coordinates of what is lit "
                                     "reach {:.3g} with the digits of 32-bit floats; "
                                     "without it vkpm chooses",
                                     name, extent.unit * double{radius}, extent.unit * minRadius(extent),
                                     extent.unit * extent.reach));
}

uint maxLevels(const Extent& extent, float radius) {
    const double cells = extent.reach / (2.1 * radius);
    uint levels = MAX_LEVELS;
    while (levels > 0 && std::ldexp(cells, static_cast<int>(levels)) > 0x1p18) levels--;
    return levels;
}

float radiusFactor(uint pass, float alpha) {
    // Gamma(n + a) / (Gamma(n + 1) Gamma(1 + a)), n = pass + 1; the logarithms of large n cancel to 1e-9 in 64 bits of
    // mantissa.
    const long double n = pass + 1.0L;
    const long double a = alpha;
    return float(std::exp((std::lgamma(n + a) - std::lgamma(n + 1) - std::lgamma(1 + a)) / 2));
}

} // namespace vkpm
