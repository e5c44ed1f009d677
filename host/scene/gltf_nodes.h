/// The nodes of a glTF scene: where meshes, cameras and lamps stand.
#pragma once
#include "scene/gltf_file.h"
#include "scene/losses.h"
#include <glm/mat4x4.hpp>

namespace vkpm {

/// What a node places, and the map from its coordinates to those of the file's scene.
struct GltfPlaced {
    glm::dmat4 matrix{1};
    Reader node;
    Reader thing; // the index of a mesh, a camera or a light
};

struct GltfNodes {
    std::vector<GltfPlaced> meshes, cameras, lights;
};

/// Of the default scene, or the first. Throws InputError for nodes that are no trees.
GltfNodes readGltfNodes(GltfFile& file, Losses& losses);

} // namespace vkpm
