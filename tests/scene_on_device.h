/// Small scenes for shader tests: shapes to a hierarchy on the device.
#pragma once
#include "map.h"
#include "render/uploaded_scene.h"
#include "scene/box.h"
#include "scene/bvh.h"
#include "shared_scene.h"

namespace vkpm {

/// A scene of triangles and then spheres, of one material.
inline Scene sceneOf(std::vector<Primitive> primitives, uint triangleCount) {
    Scene scene;
    scene.primitives = std::move(primitives);
    scene.triangleCount = triangleCount;
    addBvh(scene);
    scene.materials.push_back({MATERIAL_DIFFUSE, vec3{0.5f}, 1});
    return scene;
}

inline Primitive triangle(vec3 a, vec3 b, vec3 c) { return {a, b, c, 0, NONE, NONE}; }

inline Primitive sphere(vec3 center, float radius) {
    return {center, vec3{radius}, poleOf(center, radius), 0, NONE, NONE};
}

/// A scene whose arrays kernels can read.
struct TestScene : UploadedScene {
    explicit TestScene(const Scene& scene) : UploadedScene(testGpu(), scene, Settings{.size = {1, 1}}) {}

    MapContext context() const { return {.scene = address}; }
};

} // namespace vkpm
