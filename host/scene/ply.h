/// PLY files, ascii and binary, as arrays: vertices, normals and triangles.
#pragma once
#include "scene/indexed_mesh.h"
#include <filesystem>
#include <string_view>

namespace vkpm {

/// What a file says of the elements `vertex` (x, y, z, normals nx, ny, nz, and texture
/// coordinates s, t or u, v) and `face` (vertex_indices); all other
/// elements and properties are left aside. Throws InputError with the line, or in a binary file the byte, unless faces
/// refer to what the file has, to vertices that are finite, and there is a face; normals may be not finite.
IndexedMesh readPly(const std::filesystem::path& file, std::string_view bytes);

} // namespace vkpm
