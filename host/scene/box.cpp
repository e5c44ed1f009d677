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

} // namespace

double reachOf(const Bounds& box) {
    const vec3 corner = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::max({corner.x, corner.y, corner.z});
}

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

} // namespace vkpm
