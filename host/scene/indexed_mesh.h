/// What the readers of mesh files bring: vertices and normals, each with its own index.
#pragma once
#include "shared.h"
#include <array>
#include <map>
#include <string>
#include <vector>

namespace vkpm {

struct IndexedMesh {
    /// Indices from 0; `normal` and `coordinates` are NONE where the file gives none.
    struct Corner {
        uint vertex;
        uint normal;
        uint coordinates = NONE;
    };
    std::vector<glm::dvec3> vertices;
    std::vector<vec3> normals;                       // not of unit length
    std::map<std::size_t, std::string> wrongNormals; // those that are not finite: where they stand, such as ":12"
    std::vector<vec2> coordinates[2];                // sets with the same indices; v goes up
    std::vector<vec3> colors;                        // of all vertices, linear, within [0, 1]; or empty
    std::vector<vec4> tangents;                      // of all vertices, with the sign of the direction of v; or empty
    std::vector<std::array<Corner, 3>> triangles;
    std::vector<std::string> materials;   // that faces use, in the order of their first use
    std::vector<uint> materialOfTriangle; // index into `materials`; empty if there are none
    std::vector<std::string> leftOut;     // what the file has and a mesh here has not
    std::size_t skippedFaces = 0;         // of fewer than three corners
};

} // namespace vkpm
