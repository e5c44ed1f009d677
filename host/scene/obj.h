/// Wavefront OBJ text as arrays: vertices, normals and triangles.
#pragma once
#include "shared.h"
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

struct Obj {
    /// Indices from 0; `normal` is NONE where the file gives none.
    struct Corner {
        uint vertex;
        uint normal;
    };
    std::vector<glm::dvec3> vertices;
    std::vector<vec3> normals; // not of unit length
    std::vector<std::size_t> normalLines;
    std::vector<std::array<Corner, 3>> triangles;
    std::vector<std::string> materials; // that faces use, in the order of their first use
    std::size_t skippedFaces = 0;       // of fewer than three corners
};

/// What the lines `v`, `vn`, `usemtl` and `f` of a text say; all others are left aside. A line that ends in a backslash
/// goes on in the next one; an index of 0 stands for no normal. Throws InputError with the file's line unless faces
/// refer to what the file has, to vertices that are finite, and there is a face; normals may be not finite.
Obj readObj(const std::filesystem::path& file, std::string_view text);

} // namespace vkpm
