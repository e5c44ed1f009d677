/// The scene of the benchmark, made in memory.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// A lumpy torus of 32,768 triangles in a closed box of side 2, diffuse, with the camera inside and a light above.
Scene benchScene();

} // namespace vkpm
