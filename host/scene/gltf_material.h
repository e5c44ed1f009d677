/// Materials of glTF as a scene file says them.
#pragma once
#include "scene/gltf_texture.h"
#include "scene/losses.h"

namespace vkpm {

/// What glass of glTF without a thickness is: of closed shapes a solid, of others a pane.
enum class GltfGlass { automatic, solid, thin };

struct GltfMaterial {
    nlohmann::json material; // an element of a scene's "materials"
    vec3 radiance{0};        // that it emits
    nlohmann::json emission; // or a texture of that
    bool twoSided = false;   // on both sides
};

/// The material nearest to one of glTF's metallic-roughness model; what is lost is noted. This function alone knows how
/// glTF's words become those of scenes.
GltfMaterial readGltfMaterial(Reader material, GltfGlass glass, GltfTextures textures, Losses& losses);

/// That of a primitive without one: glTF's default values.
GltfMaterial defaultGltfMaterial();

} // namespace vkpm
