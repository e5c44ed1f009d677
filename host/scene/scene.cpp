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

/// What settings alone decide; the same for the general program.
static void chooseMaps(Features& features, const Settings& settings) {
    const bool photon = settings.integrator == INTEGRATOR_PHOTON;
    const bool map = settings.integrator == INTEGRATOR_PHOTON_MAP;
    features.hasGlobalMap &= (photon || (map && !settings.showCaustic)) && settings.photons > 0;
    features.hasCausticMap &= (photon || (map && settings.showCaustic)) && settings.causticPhotons > 0;
}

Features sceneFeatures(const Scene& scene, const Settings& settings) {
    Features features;
    if (settings.allFeatures) {
        features.stackSize = std::max(features.stackSize, scene.stackSize);
        chooseMaps(features, settings);
        return features;
    }
    const auto anyMaterial = [&](auto&& is) {
        return std::ranges::any_of(scene.primitives, [&](const Primitive& p) { return is(scene.materials[p.material]); });
    };
    const auto anyLight = [&](auto&& is) { return std::ranges::any_of(scene.lights, is); };
    features.hasTriangles = scene.triangleCount > 0;
    features.hasSpheres = scene.primitives.size() > scene.triangleCount;
    features.hasSmoothNormals = !scene.normals.empty();
    features.hasMirror = anyMaterial([](const Material& m) { return m.kind == MATERIAL_MIRROR; });
    features.hasGlass = anyMaterial([](const Material& m) { return m.kind == MATERIAL_GLASS; });
    features.hasTint = anyMaterial([](const Material& m) { return m.kind == MATERIAL_GLASS && m.color != vec3(1); });
    features.hasExactFresnel = features.hasGlass && !settings.schlick;
    features.hasSchlickFresnel = features.hasGlass && settings.schlick;
    features.hasManyLights = scene.lights.size() > 1;
    features.hasRectangleLights = anyLight([](const Light& light) { return light.kind == LIGHT_RECTANGLE; });
    features.hasTriangleLights = anyLight([](const Light& light) { return light.kind == LIGHT_TRIANGLE; });
    features.hasSphereLights = anyLight([](const Light& light) { return light.kind == LIGHT_SPHERE; });
    features.hasTwoSidedLights = anyLight([](const Light& light) { return light.twoSided != 0; });
    features.hasCausticMap = features.hasMirror || features.hasGlass;
    chooseMaps(features, settings);
    features.hasNearest = settings.nearest > 0;
    features.hasRadiusField = features.hasCausticMap && !settings.causticRadius && settings.nearest == 0;
    features.densityKernel = settings.kernel;
    features.integrator = settings.integrator;
    features.stackSize = scene.stackSize;
    return features;
}

} // namespace vkpm
