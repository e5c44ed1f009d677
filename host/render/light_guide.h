/// Light samples where light comes from, as far as the eye sees.
#pragma once
#include "render/guide.h"

namespace vkpm {

/// Gives a scene its distribution of light samples, from what lights bring to the places; `byFlux` is the CDF of lights
/// by flux. Lights are chosen in proportion to the root of the mean square of what each brings, in parts of all light
/// there, one sample of ten by flux. If there is a sky, and that is worth it, each region of space gets such a
/// distribution of its own, and one over directions of the sky (light_guide.glsl), which light samples follow where the
/// eye sees diffuse surfaces.
void learnLights(Gpu& gpu, UploadedScene& scene, const Features& features, uint seed, const GuideNeeds& needs,
                 const CameraPilot& places, std::span<const float> byFlux);

} // namespace vkpm
