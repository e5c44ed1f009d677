/// A torus with lumps of several sizes: triangles of all orientations, and rays that go far.
#include "bench/bench_scene.h"
#include "scene/bvh.h"
#include <cmath>
#include <numbers>

namespace vkpm {
using glm::dvec3;

/// The point of the torus at two angles, in units of a full turn.
static vec3 torusPoint(double u, double v) {
    const double turn = 2 * std::numbers::pi;
    const double lumps = 0.05 * std::sin(turn * (9 * u + 2 * v)) + 0.02 * std::sin(turn * (31 * u - 5 * v));
    const double tube = 0.27 * (1 + 2 * lumps) + lumps, ring = 0.58 + tube * std::cos(turn * v);
    const dvec3 flat{ring * std::cos(turn * u), tube * std::sin(turn * v), ring * std::sin(turn * u)};
    const double lean = 0.6;
    return dvec3{flat.x, std::cos(lean) * flat.y - std::sin(lean) * flat.z,
                 std::sin(lean) * flat.y + std::cos(lean) * flat.z};
}

static void addQuad(Scene& scene, vec3 a, vec3 b, vec3 c, vec3 d) {
    scene.primitives.push_back({a, b, c, 0, NONE, NONE});
    scene.primitives.push_back({a, c, d, 0, NONE, NONE});
}

static void addTorus(Scene& scene, uint around, uint across) {
    const auto point = [&](uint i, uint j) {
        return torusPoint(double(i % around) / around, double(j % across) / across);
    };
    for (uint i = 0; i < around; i++)
        for (uint j = 0; j < across; j++)
            addQuad(scene, point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j));
}

static void addBox(Scene& scene) {
    for (int axis = 0; axis < 3; axis++)
        for (const float side : {-1.0f, 1.0f}) {
            vec3 n{0}, u{0}, v{0};
            n[axis] = side;
            u[(axis + 1) % 3] = side;
            v[(axis + 2) % 3] = 1;
            addQuad(scene, n + u + v, n - u + v, n - u - v, n + u - v);
        }
}

static void addBalls(Scene& scene) {
    for (const vec3 center : {vec3{-0.45f, -0.65f, -0.35f}, vec3{0.45f, -0.65f, 0.25f}})
        scene.primitives.push_back({center, vec3{0.35f, 0, 0}, vec3{0}, 0, NONE, NONE});
}

Scene benchScene(uint around, uint across) {
    Scene scene;
    addTorus(scene, around, across);
    addBox(scene);
    scene.triangleCount = static_cast<uint>(scene.primitives.size());
    if (around == 0) addBalls(scene);
    scene.name = around == 0 ? "a box with two balls" : "a lumpy torus in a box";
    scene.materials = {{MATERIAL_DIFFUSE, vec3{0.7f}, 1}};
    scene.lights = {{{-0.25f, 0.99f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}, vec3{10}, LIGHT_RECTANGLE, 0, 0.25f, 1}};
    scene.lightCdf = {1};
    scene.bounds = {vec3{-1}, vec3{1}};
    scene.view = {{0.2f, 0.5f, 0.95f}, {0, -0.1f, 0}, {0, 1, 0}, glm::radians(75.0f)};

    addBvh(scene);
    return scene;
}

} // namespace vkpm
