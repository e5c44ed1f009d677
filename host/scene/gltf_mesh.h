/// Meshes of glTF: primitives of triangles, strips and fans.
#pragma once
#include "scene/gltf_file.h"
#include "scene/losses.h"
#include "scene/mesh.h"

namespace vkpm {

/// The triangles of an element of "primitives", in the mesh's own coordinates; none of points and lines.
Mesh readGltfPrimitive(GltfFile& file, Reader primitive, Smoothness smoothness, Losses& losses);

/// All meshes of a file's scene as one, in the scene's coordinates.
Mesh loadGltfMesh(const std::filesystem::path& path, Smoothness smoothness);

} // namespace vkpm
