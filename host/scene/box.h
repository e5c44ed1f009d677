/// Bounding boxes of primitives, rounded outward.
#pragma once
#include "scene/scene.h"
#include "shared_scene.h"

namespace vkpm {

/// The box about two.
inline Bounds united(const Bounds& one, const Bounds& other) {
    return {glm::min(one.low, other.low), glm::max(one.high, other.high)};
}

/// Whether two boxes are no farther apart than that along any axis.
inline bool areNear(const Bounds& a, const Bounds& b, double apart) {
    return glm::all(glm::lessThanEqual(glm::dvec3{a.low} - apart, glm::dvec3{b.high})) &&
           glm::all(glm::lessThanEqual(glm::dvec3{b.low} - apart, glm::dvec3{a.high}));
}

/// The greatest of a box's coordinates, signs aside.
double reachOf(const Bounds& box);

/// The box times 2^exponent; where that is not exact, it grows.
Bounds scaled(const Bounds& box, int exponent);

/// The point of a sphere that is next to the origin of coordinates, or any if all are: kernels measure from it.
vec3 poleOf(glm::dvec3 center, double radius);

/// The box of a triangle, or of a sphere of centre a and radius b.x.
Bounds boxOf(const Primitive& primitive, bool sphere);

} // namespace vkpm
