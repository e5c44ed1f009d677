/// Bounding boxes in float that are conservative: computed in double and rounded outward.
#include "scene/box.h"
#include <algorithm>
#include <cmath>

namespace vkpm {
using glm::dvec3;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float roundedDown(double x) {
    const float nearest = static_cast<float>(x);
    return double{nearest} <= x ? nearest : std::nextafter(nearest, -infinity);
}

float roundedUp(double x) { return -roundedDown(-x); }

vec3 roundedDown(dvec3 v) { return {roundedDown(v.x), roundedDown(v.y), roundedDown(v.z)}; }

vec3 roundedUp(dvec3 v) { return {roundedUp(v.x), roundedUp(v.y), roundedUp(v.z)}; }

/// Grows a box to hold a computed point, which errs by a few ulps of double and so by less than one of float.
void extendAround(Bounds& box, dvec3 point) {
    const vec3 low = roundedDown(point);
    const vec3 high = roundedUp(point);
    for (int i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], std::nextafter(low[i], -infinity));
        box.high[i] = std::max(box.high[i], std::nextafter(high[i], infinity));
    }
}

/// Boxes of the vertices on either side of the plane and of the points where edges cross it.
SplitBoxes splitTriangle(const dvec3 (&points)[3], int axis, double position) {
    SplitBoxes boxes;
    for (int i = 0; i < 3; ++i) {
        const dvec3 p = points[i];
        const dvec3 q = points[(i + 1) % 3];
        for (Bounds* box :
             {p[axis] <= position ? &boxes.below : nullptr, p[axis] >= position ? &boxes.above : nullptr}) {
            if (box == nullptr) continue;
            box->low = glm::min(box->low, roundedDown(p));
            box->high = glm::max(box->high, roundedUp(p));
        }
        if ((p[axis] < position) == (q[axis] < position) || p[axis] == position || q[axis] == position) continue;
        const dvec3 crossing = p + (q - p) * ((position - p[axis]) / (q[axis] - p[axis]));
        extendAround(boxes.below, crossing);
        extendAround(boxes.above, crossing);
    }
    return boxes;
}

/// The box of the cap of a sphere below (side -1) or above (side 1) a plane: across the other axes it is as wide as
/// the cut unless it holds the equator.
Bounds sphereCap(dvec3 center, double radius, int axis, double position, double side) {
    const double beyond = (position - center[axis]) * side;
    const double cut = std::sqrt(std::max(0.0, radius * radius - beyond * beyond));
    const double width = beyond > 0 ? cut : radius;
    dvec3 reach{width};
    reach[axis] = radius;
    Bounds box;
    extendAround(box, center - reach);
    extendAround(box, center + reach);
    return box;
}

/// The part of a box that lies in another; without volume if they are apart.
Bounds intersection(const Bounds& a, const Bounds& b) {
    const vec3 low = glm::max(a.low, b.low);
    return {low, glm::max(low, glm::min(a.high, b.high))};
}

} // namespace

Bounds scaled(const Bounds& box, int exponent) {
    const double factor = std::ldexp(1.0, exponent);
    return {roundedDown(dvec3{box.low} * factor), roundedUp(dvec3{box.high} * factor)};
}

vec3 poleOf(dvec3 center, double radius) {
    const double distance = glm::length(center);
    return vec3{distance > 0 ? center - radius / distance * center : dvec3{radius, 0, 0}};
}

Bounds boxOf(const Primitive& primitive, bool sphere) {
    if (sphere) {
        const dvec3 center{primitive.a};
        const dvec3 reach{primitive.b.x};
        return {roundedDown(center - reach), roundedUp(center + reach)};
    }
    return {glm::min(primitive.a, glm::min(primitive.b, primitive.c)),
            glm::max(primitive.a, glm::max(primitive.b, primitive.c))};
}

SplitBoxes splitBoxes(const Primitive& primitive, bool sphere, const Bounds& box, int axis, float position,
                      int exponent) {
    const double unit = std::ldexp(1.0, -exponent);
    const dvec3 points[3] = {dvec3{primitive.a} * unit, dvec3{primitive.b} * unit, dvec3{primitive.c} * unit};
    SplitBoxes parts;
    if (sphere) {
        parts.below = sphereCap(points[0], points[1].x, axis, double{position}, -1);
        parts.above = sphereCap(points[0], points[1].x, axis, double{position}, 1);
    } else {
        parts = splitTriangle(points, axis, double{position});
    }

    Bounds lower = box;
    Bounds upper = box;
    lower.high[axis] = std::min(box.high[axis], position);
    upper.low[axis] = std::max(box.low[axis], position);
    return {intersection(parts.below, lower), intersection(parts.above, upper)};
}

} // namespace vkpm
