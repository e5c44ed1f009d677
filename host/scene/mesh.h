/// Triangle meshes read from OBJ, PLY and glTF files.
#pragma once
#include "scene/indexed_mesh.h"
#include "scene/text.h"
#include "scene/transform.h"
#include "shared_textures.h"
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
    std::vector<TexturePlaces> coordinates[2]; // sets of these, of all triangles each, or empty
    std::vector<VertexColors> colors;          // of all triangles, or empty
    std::vector<Tangents> tangents;            // of all triangles with normals, or empty
    std::vector<uint> materials;               // of all triangles: index into `materialNames`; or empty
    std::vector<std::string> materialNames;
    std::vector<std::string> warnings;
    std::vector<FileRead> files; // that were read
};

/// Tangents of a triangle that a transform moves: its corners b and c change places where it mirrors.
Tangents transformed(const Tangents& tangents, const Transform& transform);

/// The mesh of an OBJ, PLY or glTF file, whatever its name; polygons are triangulated. Throws InputError with the place
/// of what is not sound.
Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness);

/// What a reader brought, as a mesh. `smooth` computes the normals that the file lacks, weighted by angle (Thuermer &
/// Wuethrich 1998). Throws InputError for a normal that is not finite.
Mesh meshOf(const std::filesystem::path& file, const IndexedMesh& from, Smoothness smoothness);

} // namespace vkpm
