/// Materials of a scene file.
#pragma once
#include "scene/reader.h"
#include "scene/textures.h"
#include "shared_scene.h"

namespace vkpm {

/// Whether it has a lobe that sends light on in one direction, or about it.
inline bool isNarrow(const Material& material) { return material.kind != MATERIAL_DIFFUSE && material.wide == 0; }

/// A material as kernels read it; what it needs of rests and textures is added to those of the scene. Throws
/// InputError.
Material readMaterial(Reader reader, Textures& textures);

/// Says by what the caustics are found that fall on wide lobes, when the media are known: by photons, but on sheets of
/// glass, on glass with a normal map or with a standard material beside it, on glass that hardly refracts (what it lets
/// through stays a narrow beam), and on all glass where paths know media.
void chooseWide(Scene& scene);

} // namespace vkpm
