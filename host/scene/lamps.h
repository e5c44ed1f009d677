/// The "lights" of a scene file: suns, points and spots.
#pragma once
#include "scene/reader.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include <optional>

namespace vkpm {

/// Suns, which come before all lights that have a place.
void addSuns(const Reader& lights, Scene& scene);

/// Points and spots; a point with a radius is a sphere that emits. Throws InputError for whatever is wrong, suns
/// included.
void addLamps(const Reader& lights, Scene& scene, ShapeLoader& loader);

} // namespace vkpm
