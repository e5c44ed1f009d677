/// Textures of glTF as a scene file says them.
#pragma once
#include "scene/gltf_file.h"
#include "scene/losses.h"
#include "scene/textures.h"

namespace vkpm {

class GltfTextures {
public:
    GltfTextures(GltfFile& from, Textures& images, Losses& lost) : file{from}, textures{images}, losses{lost} {}

    /// A texture object of a scene file for what glTF calls a texture info, whose image it makes known to scenes; none,
    /// and a loss, if vkpm cannot read it.
    std::optional<nlohmann::json> read(Reader info, bool isColor);

    /// That of the roughness which the alpha of such a texture, as gloss, stands for.
    std::optional<nlohmann::json> roughnessOfGloss(const Reader& info, float gloss);

private:
    std::optional<std::string> imageOf(Reader& texture);

    GltfFile& file;
    Textures& textures;
    Losses& losses;
};

} // namespace vkpm
