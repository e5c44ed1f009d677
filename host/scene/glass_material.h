/// Glass of a scene file.
#pragma once
#include "scene/reader.h"
#include "scene/scene.h"

namespace vkpm {

/// Glass of these indices as kernels read it, rough or smooth. What it is filled with, "attenuation", "abbe" and
/// "priority", or that it is "thin", `reader` says; Scene::media gets it. Throws InputError.
Material readGlass(Reader& reader, Scene& scene, vec3 tint, float ior, float exteriorIor, float roughness);

} // namespace vkpm
