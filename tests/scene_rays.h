/// Random rays in a scene, and those that tests of rays find hard.
#pragma once
#include "exact_rays.h"
#include "shared_scene.h"
#include <random>
#include <vector>

namespace vkpm {

class RayMaker {
public:
    explicit RayMaker(const Scene& source) : scene{source} {}

    /// Kinds of rays in turn: random ones, for which isRandom(index), from surfaces, others along axes, to corners and
    /// to edges.
    std::vector<TestRay> rays(uint count) {
        std::vector<TestRay> result;
        for (uint i = 0; i < count; ++i) {
            switch (i % 8) {
            case 4:
                result.push_back(alongAxis());
                break;
            case 5:
                result.push_back(alongPlane());
                break;
            case 6:
                result.push_back(toward(corner(primitive())));
                break;
            case 7:
                result.push_back(toward(edgePoint(primitive())));
                break;
            default:
                result.push_back(i % 2 == 0 ? TestRay{anywhere(), direction()} : leave(primitive()));
            }
        }
        return result;
    }

    static bool isRandom(uint index) { return index % 8 < 4 && index % 2 == 0; }

    /// Rays from surface to surface, or from anywhere to a surface; `direction` leads to the end.
    std::vector<TestRay> segments(uint count) {
        std::vector<TestRay> result;
        for (uint i = 0; i < count; ++i) {
            TestRay ray = i % 4 == 0 ? TestRay{anywhere(), {}} : leave(primitive());
            ray.direction = leave(primitive(), true).origin - ray.origin;
            result.push_back(ray);
        }
        return result;
    }

    /// Rays that leave the halves of a rectangle across an axis, triangles 2 k and 2 k + 1.
    std::vector<TestRay> leavingRectangles(uint count) {
        std::vector<uint> flat;
        for (uint i = 0; i + 1 < scene.triangleCount; i += 2)
            if (isFlat(scene.primitives[i], scene.primitives[i + 1])) flat.insert(flat.end(), {i, i + 1});
        std::vector<TestRay> result;
        while (!flat.empty() && result.size() < count) result.push_back(leave(flat[result.size() % flat.size()]));
        return result;
    }

private:
    static bool isFlat(const Primitive& p, const Primitive& q) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto in = [&](vec3 point) { return point[axis] == p.a[axis]; };
            if (in(p.b) && in(p.c) && in(q.a) && in(q.b) && in(q.c)) return true;
        }
        return false;
    }
    float uniform() { return std::uniform_real_distribution<float>{}(random); }
    uint below(std::size_t count) { return static_cast<uint>(random() % count); }
    uint primitive() { return below(scene.primitives.size()); }
    bool isSphere(uint id) const { return id >= scene.triangleCount; }

    vec3 direction() {
        const float z = 1 - 2 * uniform(), phi = 6.2831853f * uniform(), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    vec3 anywhere() {
        return scene.bounds.low + vec3{uniform(), uniform(), uniform()} * (scene.bounds.high - scene.bounds.low);
    }

    /// A corner of a triangle, or a point of a sphere on an axis.
    vec3 corner(uint id) {
        const Primitive& p = scene.primitives[id];
        vec3 result = p.a;
        const int which = static_cast<int>(below(3));
        if (isSphere(id)) result[which] += uniform() < 0.5f ? p.b.x : -p.b.x;
        else result = which == 0 ? p.a : which == 1 ? p.b : p.c;
        return result;
    }

    vec3 edgePoint(uint id) {
        const Primitive& p = scene.primitives[id];
        return isSphere(id) ? p.a + p.b.x * direction() : glm::mix(p.a, p.b, uniform() < 0.5f ? 0.5f : uniform());
    }

    /// A ray from a surface, on either side of it and moved off it as kernels do; a point of a light, at which a shadow
    /// ray ends, moves farther.
    TestRay leave(uint id, bool light = false) {
        const Primitive& p = scene.primitives[id];
        vec2 x{uniform(), uniform()};
        if (x.x + x.y > 1) x = 1.0f - x;
        const vec3 onTriangle = (1 - x.x - x.y) * p.a + x.x * p.b + x.y * p.c, outward = direction();
        const vec3 point = isSphere(id) ? p.a + p.b.x * outward : onTriangle;
        const vec3 n = isSphere(id) ? outward : glm::normalize(glm::cross(p.b - p.a, p.c - p.a));
        const vec3 magnitude = glm::abs(p.a) + (isSphere(id) ? vec3{p.b.x} : glm::abs(p.b) + glm::abs(p.c));
        const float largest = std::max({magnitude.x, magnitude.y, magnitude.z});
        const float offset = 0x1p-18f * glm::dot(glm::abs(n), light ? vec3{largest} : magnitude);
        const vec3 d = direction();
        return {point + (glm::dot(n, d) > 0 ? n : -n) * offset, d, id};
    }

    /// Two zero components; half of these rays lie in planes of boxes and pass through a corner.
    TestRay alongAxis() {
        const int axis = static_cast<int>(below(3));
        const vec3 inside = anywhere();
        vec3 origin = uniform() < 0.5f ? inside : corner(primitive());
        origin[axis] = inside[axis];
        vec3 d{0.0f, -0.0f, 0.0f};
        d[axis] = uniform() < 0.5f ? 1.0f : -1.0f;
        return {origin, d};
    }
    TestRay alongPlane() {
        TestRay ray{anywhere(), direction()};
        ray.direction[static_cast<int>(below(3))] = uniform() < 0.5f ? 0.0f : -0.0f;
        return ray;
    }
    TestRay toward(vec3 point) {
        const vec3 origin = anywhere();
        return {origin, point - origin};
    }

    const Scene& scene;
    std::mt19937 random{17};
};

} // namespace vkpm
