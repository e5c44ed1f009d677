/// Rays that leave a surface do not meet it again, at any scale, and surfaces are what their primitives say.
#include "judge.h"
#include "scene_on_device.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

const Features flat{.hasSmoothNormals = 0};

// Any scene: flat primitives read nothing of it.
MapContext someScene() {
    static const TestScene scene(sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1));
    return scene.context();
}

vec2 weightsOf(vec2 u) { return u.x + u.y > 1 ? vec2(1) - u : u; }

// Random triangles of sides of `scale` about a point `away` from the origin; none that rounding made degenerate.
std::vector<LeavingCase> leavingTriangles(float scale, float away, int count, Random& random) {
    std::vector<LeavingCase> xs;
    while (count-- > 0) {
        const vec3 center = away * random.direction();
        const Primitive p =
            triangle(center + random.cube(scale), center + random.cube(scale), center + random.cube(scale));
        if (glm::cross(dvec3(p.b) - dvec3(p.a), dvec3(p.c) - dvec3(p.a)) == dvec3(0)) continue;
        xs.push_back({p, weightsOf(random.unit2()), vec3(0), random.direction()});
    }
    return xs;
}

TEST(Offset, RaysThatLeaveATriangleDoNotHitItAgain) {
    Random random(1);
    for (const float scale : {1e-4f, 1e-2f, 1.0f, 1e2f, 1e4f})
        for (const float away : {0.0f, 1e-2f, 1.0f, 1e2f, 1e4f}) {
            const auto xs = leavingTriangles(scale, away, 10'000, random);
            const auto ys = map<Leaving>("leave_triangle", xs, flat, someScene());
            for (std::size_t i = 0; i < xs.size(); i++)
                ASSERT_LE(ys[i].t, 0) << "scale " << scale << ", away " << away << ", cosine "
                                      << glm::dot(ys[i].normal, xs[i].direction);
        }
}

// The offset is about 64 roundings of what the position came from: not more, or thin walls would leak.
TEST(Offset, OffsetsAreSmall) {
    Random random(2);
    for (const float scale : {1e-4f, 1.0f, 1e4f})
        for (const float away : {0.0f, 1.0f, 1e4f}) {
            const auto xs = leavingTriangles(scale, away, 1'000, random);
            const auto ys = map<Leaving>("leave_triangle", xs, flat, someScene());
            for (std::size_t i = 0; i < xs.size(); i++) {
                const dvec3 p = dvec3(xs[i].primitive.a) * (1.0 - double{xs[i].weights.x} - double{xs[i].weights.y}) +
                                dvec3(xs[i].primitive.b) * double{xs[i].weights.x} +
                                dvec3(xs[i].primitive.c) * double{xs[i].weights.y};
                ASSERT_LT(glm::length(dvec3(ys[i].origin) - p), 1e-4 * double{scale + away});
            }
        }
}

TEST(Offset, RaysThatLeaveASphereDoNotHitWhereTheyLeft) {
    Random random(3);
    for (const float radius : {1e-4f, 1e-2f, 1.0f, 1e2f, 1e4f})
        for (const float away : {0.0f, 1.0f, 1e2f}) {
            std::vector<LeavingCase> xs;
            for (int i = 0; i < 20'000; i++) {
                const vec3 center = away * random.direction();
                const vec3 n = random.direction() * radius * random.between(0.9999f, 1.0001f);
                xs.push_back({sphere(center, radius), vec2(0), center + n, random.direction()});
            }
            const auto ys = map<Leaving>("leave_sphere", xs, flat, someScene());
            for (std::size_t i = 0; i < xs.size(); i++) {
                const double cosine = glm::dot(dvec3(ys[i].normal), dvec3(xs[i].direction));
                if (radius < 1e-5f * away) continue; // smaller than the rounding of its place
                if (cosine > 0) {
                    ASSERT_EQ(ys[i].t, -1) << "radius " << radius << ", away " << away << ", cosine " << cosine;
                }
                // Inward the ray crosses the sphere: it must not end where it began.
                const double offset = 4e-6 * 3 * double{radius + away};
                if (cosine < -10 * offset / double{radius} - 0.01) {
                    ASSERT_GT(ys[i].t, -cosine * double{radius}) << radius << " " << away;
                }
            }
        }
}

TEST(Offset, ScalesByPowersOfTwo) {
    Random random(4);
    std::vector<OffsetCase> xs, scaled;
    for (const float factor : {0x1p-40f, 0x1p-3f, 2.0f, 0x1p50f})
        for (int i = 0; i < 1'000; i++) {
            const vec3 p = random.cube(10), m = glm::abs(p) + glm::abs(random.cube(1)), n = random.direction();
            xs.push_back({p, m, n});
            scaled.push_back({p * factor, m * factor, n});
        }
    const auto ys = map<vec3>("offset_point", xs), zs = map<vec3>("offset_point", scaled);
    for (std::size_t i = 0; i < xs.size(); i++) {
        ASSERT_EQ(zs[i], ys[i] * (scaled[i].position.x / xs[i].position.x));
        ASSERT_GT(glm::dot(dvec3(ys[i]) - dvec3(xs[i].position), dvec3(xs[i].normal)), 0);
    }
}

TEST(Surface, OfATriangle) {
    Scene scene = sceneOf({triangle({1, 2, 3}, {3, 2, 3}, {1, 5, 3})}, 1);
    scene.primitives[0].material = 7;
    scene.primitives[0].light = 9;
    scene.primitives[0].normals = 0;
    const vec3 na = glm::normalize(vec3{1, 0, 1}), nb = glm::normalize(vec3{0, 1, 2}),
               nc = glm::normalize(vec3{-1, -1, 1});
    for (const float side : {1.0f, -1.0f}) {
        scene.normals = {{side * na, side * nb, side * nc}};
        const TestScene uploaded(scene);
        for (const bool smooth : {false, true}) {
            const SurfaceCase x{.path = {}, .hit = {1, 0, vec2{0.25f, 0.5f}}};
            const SurfaceValues y =
                map<SurfaceValues>("surface_at", std::vector{x}, {.hasSmoothNormals = smooth}, uploaded.context())[0];
            EXPECT_EQ(y.position, (vec3{1.5f, 3.5f, 3}));
            EXPECT_EQ(y.magnitude, (vec3{5, 9, 9}));
            EXPECT_LT(glm::length(y.normal - vec3{0, 0, 1}), 1.3e-7); // drivers take roots and divide to some ulps
            const vec3 shading = smooth ? glm::normalize(0.25f * na + 0.25f * nb + 0.5f * nc) : y.normal;
            EXPECT_LT(glm::length(y.shading - shading), 1e-6) << "on the side of the geometric normal";
            EXPECT_EQ(y.material, 7u);
            EXPECT_EQ(y.light, 9u);
        }
    }
}

// The point is put onto the sphere, wherever t left it.
TEST(Surface, OfASphere) {
    const Scene scene = sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), sphere({1, -2, 3}, 2)}, 1);
    const TestScene uploaded(scene);
    const SurfaceCase x{.path = {.origin = {1, -2, 10}, .direction = {0, 0, -1}}, .hit = {5.001f, 1, vec2(0)}};
    const SurfaceValues y = map<SurfaceValues>("surface_at", std::vector{x}, {}, uploaded.context())[0];
    EXPECT_LT(glm::distance(y.position, vec3(1, -2, 5)), 2e-6f);
    const float fromPole = glm::distance(vec3(1, -2, 5), poleOf({1, -2, 3}, 2));
    EXPECT_LT(glm::distance(y.magnitude, vec3(1, 2, 5) + fromPole), 2e-6f);
    EXPECT_EQ(y.normal, (vec3{0, 0, 1}));
    EXPECT_EQ(y.shading, y.normal);
    EXPECT_EQ(y.light, NONE);
}

} // namespace
} // namespace vkpm
