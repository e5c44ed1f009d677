/// Wavefront OBJ text as arrays: vertices, normals and triangles.
#pragma once
#include "shared.h"
#include <array>
#include <filesystem>
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
    std::vector<std::array<Corner, 3>> triangles;
};

/// What the lines `v`, `vn` and `f` of a text say; all others are left aside. Throws InputError with the file's line
/// unless numbers are finite, faces refer to what the file has, and there is a face.
Obj readObj(const std::filesystem::path& file, std::string_view text);

} // namespace vkpm
