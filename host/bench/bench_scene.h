/// The scenes of the benchmark, made in memory.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// A closed box of side 2, diffuse, with the camera inside and a light above; in it a lumpy torus of 2 x around x
/// across triangles, or two balls if there are none.
Scene benchScene(uint around, uint across);

} // namespace vkpm
