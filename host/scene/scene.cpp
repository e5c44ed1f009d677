/// What a scene gives the kernels besides its arrays: the camera and the features.
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace vkpm {
using glm::dvec3;

Camera pinholeCamera(const View& view, uvec2 size) {
    const double tangent = std::tan(double{view.fieldOfView} / 2);
    const double aspect = double(size.x) / double(size.y);
    const dvec3 forward = glm::normalize(dvec3{view.target} - dvec3{view.origin});
    const dvec3 right = glm::normalize(glm::cross(forward, glm::normalize(dvec3{view.up})));
    const dvec3 up = glm::cross(right, forward);
    return {view.origin, vec3{forward}, vec3{right * (tangent * aspect)}, vec3{up * tangent}};
}

Features sceneFeatures(const Scene& scene, const Settings& settings) {
    const auto anyOf = [&](uint kind) {
        return std::ranges::any_of(scene.primitives,
                                   [&](const Primitive& p) { return scene.materials[p.material].kind == kind; });
    };
    Features features;
    features.hasTriangles = scene.triangleCount > 0;
    features.hasSpheres = scene.primitives.size() > scene.triangleCount;
    features.hasSmoothNormals = !scene.normals.empty();
    features.hasMirror = anyOf(MATERIAL_MIRROR);
    features.hasGlass = anyOf(MATERIAL_GLASS);
    features.hasManyLights = scene.lights.size() > 1;
    features.hasSchlick = settings.schlick;
    features.stackSize = scene.stackSize;
    features.integrator = settings.integrator;
    features.densityKernel = settings.kernel;
    features.hasNearest = settings.nearest > 0;
    return features;
}

} // namespace vkpm
