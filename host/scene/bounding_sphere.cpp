/// Enclosing spheres: Ritter's approximation with refinement.
#include "scene/bounding_sphere.h"
#include <algorithm>
#include <limits>

namespace vkpm {
using glm::dvec3;

namespace {

struct Sphere {
    dvec3 center{0};
    double radius = 0;
};

vec3 farthest(std::span<const vec3> points, dvec3 from) {
    return *std::ranges::max_element(points, {}, [&](vec3 p) { return glm::distance(dvec3{p}, from); });
}

/// Grows the sphere just enough for each point in turn (Ritter 1990, "An Efficient Bounding Sphere").
void grow(Sphere& sphere, std::span<const vec3> points) {
    for (const vec3 point : points) {
        const double distance = glm::distance(dvec3{point}, sphere.center);
        if (distance <= sphere.radius) continue;
        const double radius = (sphere.radius + distance) / 2;
        sphere.center += (dvec3{point} - sphere.center) * ((radius - sphere.radius) / distance);
        sphere.radius = radius;
    }
}

/// Ritter's sphere, from two points far apart; the smallest of several that start from it shrunk a little.
Sphere smallSphere(std::span<const vec3> points) {
    const vec3 one = farthest(points, dvec3{points[0]});
    const vec3 other = farthest(points, dvec3{one});
    Sphere best{(dvec3{one} + dvec3{other}) / 2.0, glm::distance(dvec3{one}, dvec3{other}) / 2};
    grow(best, points);

    Sphere trial = best;
    for (int round = 0; round < 16; ++round) {
        trial.radius *= 0.95;
        grow(trial, points);
        if (trial.radius < best.radius) best = trial;
    }
    return best;
}

} // namespace

Target boundingSphere(std::span<const vec3> points) {
    const vec3 center{smallSphere(points).center};
    const double radius = glm::distance(dvec3{farthest(points, dvec3{center})}, dvec3{center});

    // A distance computed in float errs by the rounding of a sum of squares: by less than 4 ulps.
    constexpr double margin = 1 + 8 * double{std::numeric_limits<float>::epsilon()};
    return {center, static_cast<float>(radius * margin)};
}

} // namespace vkpm
