/// Materials of a scene file.
#pragma once
#include "scene/reader.h"
#include "scene/scene.h"
#include "shared_scene.h"

namespace vkpm {

/// Widths of lobes, alpha, below this are those of a mirror: in 32-bit floats, nothing is left of the density of
/// facets.
constexpr float smoothestAlpha = 1e-3f;

/// A material as kernels read it; what it needs of Scene::rests and Scene::media is added. Throws InputError.
Material readMaterial(Reader reader, Scene& scene);

} // namespace vkpm
