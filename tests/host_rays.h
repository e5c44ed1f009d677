/// Rays on the host in double precision, through our hierarchy: the yardstick for its tests.
#pragma once
#include "scene/bvh.h"
#include "shared_scene.h"
#include <cmath>
#include <functional>
#include <limits>

namespace vkpm {

using glm::dvec3;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct HostHit {
    double t = infinity;
    uint id = NONE;
};

/// Moeller & Trumbore (1997), in double precision.
inline double intersectTriangle(dvec3 origin, dvec3 direction, dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 u = b - a, v = c - a, p = glm::cross(direction, v);
    const double determinant = glm::dot(u, p);
    if (determinant == 0) return infinity;
    const dvec3 s = origin - a, q = glm::cross(s, u);
    const double x = glm::dot(s, p) / determinant, y = glm::dot(direction, q) / determinant;
    const double t = glm::dot(v, q) / determinant;
    return x >= 0 && y >= 0 && x + y <= 1 && t > 0 ? t : infinity;
}

inline double intersectSphere(dvec3 origin, dvec3 direction, dvec3 center, double radius) {
    const dvec3 f = origin - center;
    const double a = glm::dot(direction, direction), b = glm::dot(f, direction), c = glm::dot(f, f) - radius * radius;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return infinity;
    const double near = (-b - std::sqrt(discriminant)) / a, far = (-b + std::sqrt(discriminant)) / a;
    return near > 0 ? near : far > 0 ? far : infinity;
}

inline double intersect(dvec3 origin, dvec3 direction, dvec3 a, dvec3 b, dvec3 c, bool sphere) {
    return sphere ? intersectSphere(origin, direction, a, b.x) : intersectTriangle(origin, direction, a, b, c);
}

/// Whether a ray meets a box, with a margin for the rounding of double.
inline bool meetsBox(dvec3 origin, dvec3 direction, vec3 low, vec3 high) {
    if (low.x > high.x) return false;
    double enter = 0, leave = infinity;
    for (int i = 0; i < 3; ++i) {
        const double one = (double{low[i]} - origin[i]) / direction[i],
                     other = (double{high[i]} - origin[i]) / direction[i];
        enter = std::max(enter, std::min(one, other) * (1 - 1e-12));
        leave = std::min(leave, std::max(one, other) * (1 + 1e-12));
    }
    return enter <= leave;
}

inline void updateHit(HostHit& hit, double t, uint id) {
    if (t < infinity && (t < hit.t || (t == hit.t && id < hit.id))) hit = {t, id};
}

inline HostHit closestByTree(const Bvh& bvh, uint triangleCount, dvec3 origin, dvec3 direction) {
    HostHit hit;
    const std::function<void(uint)> visit = [&](uint child) {
        if ((child & LEAF) != 0) {
            const uint first = child & LEAF_FIRST, count = ((child & ~LEAF) >> LEAF_SHIFT) + 1;
            for (uint i = first; i < first + count; ++i) {
                const Leaf& leaf = bvh.leaves.at(i);
                updateHit(hit, intersect(origin, direction, leaf.a, leaf.b, leaf.c, leaf.id >= triangleCount), leaf.id);
            }
            return;
        }
        const Node& node = bvh.nodes.at(child);
        if (meetsBox(origin, direction, node.leftLow, node.leftHigh)) visit(node.left);
        if (meetsBox(origin, direction, node.rightLow, node.rightHigh)) visit(node.right);
    };
    visit(0);
    return hit;
}

} // namespace vkpm
