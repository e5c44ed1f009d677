/// Materials of a scene file.
#pragma once
#include "scene/reader.h"
#include "shared_scene.h"

namespace vkpm {

/// A material as kernels read it. Throws InputError.
Material readMaterial(Reader reader);

} // namespace vkpm
