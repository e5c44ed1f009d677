/// The sky of a scene file: its picture as tables by which directions are chosen.
#pragma once
#include "scene/reader.h"
#include "scene/scene.h"

namespace vkpm {

/// The value of "environment": adds its light and its tables to the scene, and its file to those that were read.
/// Throws InputError.
void readEnvironment(Reader environment, Scene& scene);

/// The same radiance from everywhere.
void addConstantSky(Scene& scene, vec3 radiance);

} // namespace vkpm
