/// Rays in double precision, to judge those of floats.
///
/// A float result is right if it is the exact result for a ray whose origin is displaced by a few roundings of the
/// numbers that the test subtracts: DISPLACEMENT times the largest distance from the origin to the primitive.
/// Watertight meshes follow from that: where all displaced rays hit a surface, so must the ray.
#pragma once
#include "scene/scene.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include <algorithm>
#include <cmath>
#include <span>

namespace vkpm {
using glm::dvec3;

struct TestRay {
    vec3 origin;
    vec3 direction;
    uint from = NONE; // primitive that the ray leaves; if a triangle, the ray cannot hit it
};

// A coordinate goes through about eight roundings of 2^-24 each until it decides: the difference to the origin, the
// shear, its product and difference, and the products and difference of two coordinates; a coordinate is up to twice
// the distance.
inline constexpr double DISPLACEMENT = 16 * 0x1p-24;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Largest distance from a point to a primitive.
inline double reachOf(dvec3 origin, const Primitive& p, bool sphere) {
    const double a = glm::distance(origin, dvec3{p.a});
    return sphere ? a + double{p.b.x}
                  : std::max({a, glm::distance(origin, dvec3{p.b}), glm::distance(origin, dvec3{p.c})});
}

/// Where a ray hits a triangle (Moeller & Trumbore 1997), or infinity.
inline double exactTriangle(dvec3 origin, dvec3 direction, const Primitive& p) {
    const dvec3 u = dvec3{p.b} - dvec3{p.a}, v = dvec3{p.c} - dvec3{p.a}, s = origin - dvec3{p.a};
    const dvec3 n = glm::cross(direction, v), q = glm::cross(s, u);
    const double determinant = glm::dot(u, n);
    const double x = glm::dot(s, n) / determinant, y = glm::dot(direction, q) / determinant,
                 t = glm::dot(v, q) / determinant;
    return x >= 0 && y >= 0 && x + y <= 1 && t > 0 ? t : infinity;
}

/// Where a ray hits a sphere, or infinity.
inline double exactSphere(dvec3 origin, dvec3 direction, const Primitive& p) {
    const dvec3 f = origin - dvec3{p.a}, d = glm::normalize(direction);
    const dvec3 across = f - glm::dot(f, d) * d;
    const double discriminant = double{p.b.x} * double{p.b.x} - glm::dot(across, across);
    if (discriminant < 0) return infinity;
    const double middle = -glm::dot(f, d), half = std::sqrt(discriminant),
                 t = middle - half > 0 ? middle - half : middle + half;
    return t > 0 ? t / glm::length(direction) : infinity;
}

/// What double precision says of a ray: the exact hits of all rays displaced by no more than rounding.
class Judge {
public:
    explicit Judge(const Scene& judged) : scene{judged}, displacements{dvec3{0}} {
        for (const double size : {0.1, 0.4, 1.0})
            for (int i = 0; i < 256; ++i) {
                const double z = 1 - (2 * i + 1) / 256.0, phi = 2.399963 * i; // golden angle
                displacements.push_back(
                    size * dvec3{std::sqrt(1 - z * z) * dvec3{std::cos(phi), std::sin(phi), 0} + dvec3{0, 0, z}});
            }
    }

    bool isSphere(uint id) const { return id >= scene.triangleCount; }

    /// Whether a hit is that of one of the displaced rays: the same primitive, or another at the same distance.
    bool accepts(const TestRay& ray, const Hit& hit) const {
        const std::vector<uint> near = nearRay(ray);
        return std::ranges::any_of(displacements, [&](dvec3 displacement) {
            const Hit exact = closest(ray, displacement, near);
            if (exact.primitive == hit.primitive) return true;
            return exact.primitive != NONE && hit.primitive != NONE && std::abs(exact.t - hit.t) <= tolerance(ray, hit);
        });
    }

    bool accepts(const TestRay& ray, bool occluded) const {
        const std::vector<uint> near = nearRay(ray);
        return std::ranges::any_of(
            displacements, [&](dvec3 displacement) { return (closest(ray, displacement, near).t < 1) == occluded; });
    }

    /// How far rounding may move t: a displacement moves it by up to the displacement over the cosine, and a triangle's
    /// weights, each rounded on its own, by as much times its length over its height.
    double tolerance(const TestRay& ray, const Hit& hit) const {
        const Primitive& p = scene.primitives[hit.primitive];
        const dvec3 o{ray.origin}, d{ray.direction}, u = dvec3{p.b} - dvec3{p.a}, v = dvec3{p.c} - dvec3{p.a};
        const bool sphere = isSphere(hit.primitive);
        const dvec3 n = sphere ? o + double{hit.t} * d - dvec3{p.a} : glm::cross(u, v);
        const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(u - v, u - v)});
        const double slender = sphere ? 1 : longest / glm::length(n);
        return DISPLACEMENT * reachOf(o, p, sphere) * slender * glm::length(n) / std::abs(glm::dot(n, d));
    }

    /// Distance of a hit, in units of the tolerance, from the plane or sphere that it is said to lie on.
    double error(const TestRay& ray, const Hit& hit) const {
        const Primitive& p = scene.primitives[hit.primitive];
        const dvec3 o{ray.origin}, d{ray.direction}, point = o + double{hit.t} * d;
        const dvec3 n = glm::cross(dvec3{p.b} - dvec3{p.a}, dvec3{p.c} - dvec3{p.a});
        const double away = isSphere(hit.primitive) ? (glm::distance(point, dvec3{p.a}) - double{p.b.x}) /
                                                          glm::dot(glm::normalize(point - dvec3{p.a}), d)
                                                    : glm::dot(point - dvec3{p.a}, n) / glm::dot(n, d);
        return std::abs(away) / tolerance(ray, hit);
    }

private:
    /// Primitives that a displaced ray can meet, by spheres about them.
    std::vector<uint> nearRay(const TestRay& ray) const {
        const dvec3 o{ray.origin}, d = glm::normalize(dvec3{ray.direction});
        std::vector<uint> near;
        for (uint i = 0; i < scene.primitives.size(); ++i) {
            if (i == ray.from && !isSphere(i)) continue;
            const Primitive& p = scene.primitives[i];
            const dvec3 f = o - dvec3{p.a}, across = f - glm::dot(f, d) * d;
            const double radius =
                isSphere(i) ? double{p.b.x} : double{std::max(glm::distance(p.a, p.b), glm::distance(p.a, p.c))};
            const double limit = radius * 1.001 + 2 * DISPLACEMENT * (glm::length(f) + radius);
            if (glm::dot(across, across) <= limit * limit) near.push_back(i);
        }
        return near;
    }

    Hit closest(const TestRay& ray, dvec3 displacement, std::span<const uint> near) const {
        Hit hit{std::numeric_limits<float>::infinity(), NONE, vec2{0}};
        double nearest = infinity;
        for (const uint i : near) {
            const Primitive& p = scene.primitives[i];
            const dvec3 d{ray.direction};
            const dvec3 o =
                dvec3{ray.origin} + DISPLACEMENT * reachOf(dvec3{ray.origin}, p, isSphere(i)) * displacement;
            const double t = isSphere(i) ? exactSphere(o, d, p) : exactTriangle(o, d, p);
            if (t < nearest) hit = {static_cast<float>(nearest = t), i, vec2{0}};
        }
        return hit;
    }

    const Scene& scene;
    std::vector<dvec3> displacements; // in units of the largest
};

} // namespace vkpm
