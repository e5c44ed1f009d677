/// What a scene and its settings need of the kernels, as specialization constants; the rest is left out.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// Whether there are materials of the kinds given as bits: DIFFUSE_KINDS, SPECULAR_KINDS.
inline bool hasMaterials(const Features& features, uint kinds) { return (features.materialKinds & kinds) != 0; }

/// What the scene has, as specialization constants; settings add integrator, kernel, Fresnel and the layers asked for.
Features sceneFeatures(const Scene& scene, const Settings& settings);

/// Leaves out the layers that nobody asked for; `layers` are bits by place in layerNames.
void askFor(uint layers, Features& features);

/// Whether any camera path asks a light for its direct part, whether any asks a photon map.
bool asksLights(const Features& features, const Settings& settings);
bool asksMaps(const Features& features);

/// Whether photons are connected to the camera.
bool tracesLight(const Features& features, const Settings& settings);

} // namespace vkpm
