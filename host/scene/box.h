/// Bounding boxes of primitives and of their parts on the sides of a plane, rounded outward.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// The box times 2^exponent; where that is not exact, it grows.
Bounds scaled(const Bounds& box, int exponent);

/// The point of a sphere that is next to the origin of coordinates, or any if all are: kernels measure from it.
vec3 poleOf(glm::dvec3 center, double radius);

/// The box of a triangle, or of a sphere of centre a and radius b.x.
Bounds boxOf(const Primitive& primitive, bool sphere);

/// Boxes of the parts of a primitive that lie in `box` and below or above a plane across an axis, all in units of
/// 2^exponent; an empty part has a box without volume.
struct SplitBoxes {
    Bounds below;
    Bounds above;
};
SplitBoxes splitBoxes(const Primitive& primitive, bool sphere, const Bounds& box, int axis, float position,
                      int exponent);

} // namespace vkpm
