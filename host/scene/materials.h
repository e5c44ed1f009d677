/// Materials of a scene file.
#pragma once
#include "scene/reader.h"
#include "shared_scene.h"

namespace vkpm {

/// A material as kernels read it; what it needs of Scene::rests is added to `rests`. Throws InputError.
Material readMaterial(Reader reader, std::vector<float>& rests);

} // namespace vkpm
