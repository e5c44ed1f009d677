/// Triangle meshes read from Wavefront OBJ files.
#pragma once
#include "shared.h"
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkpm {

/// Which normals a mesh is shaded with.
enum class Smoothness { fromFile, smooth, flat };

/// Triangles with their winding as in the file; a triangle without normals is flat.
struct Mesh {
    struct Triangle {
        std::array<glm::dvec3, 3> points;
        std::optional<std::array<vec3, 3>> normals; // not of unit length
    };
    std::vector<Triangle> triangles;
    std::vector<std::string> warnings;
};

/// The mesh of an OBJ file, polygons triangulated. `smooth` computes the normals that the file lacks,
/// weighted by angle (Thuermer & Wuethrich 1998). Throws InputError with file:line for what is not sound.
Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness);

} // namespace vkpm
