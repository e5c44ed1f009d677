/// Wavefront OBJ text as arrays: vertices, normals and triangles.
#pragma once
#include "scene/indexed_mesh.h"
#include <filesystem>
#include <string_view>

namespace vkpm {

/// What the lines `v`, `vn`, `vt`, `usemtl` and `f` of a text say; all others are left aside. A line that ends in a
/// backslash goes on in the next one; an index of 0 stands for no normal. Throws InputError with the file's line unless
/// faces refer to what the file has, to vertices that are finite, and there is a face; normals may be not finite.
IndexedMesh readObj(const std::filesystem::path& file, std::string_view text);

} // namespace vkpm
