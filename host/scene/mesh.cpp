/// Triangle meshes from OBJ files, with the normals of the file or computed ones.
#include "scene/mesh.h"
#include "scene/obj.h"
#include "scene/text.h"
#include <cmath>

namespace vkpm {
using glm::dvec3;

namespace {

using Corners = std::array<Obj::Corner, 3>;

std::array<dvec3, 3> pointsOf(const Obj& obj, const Corners& corners) {
    return {obj.vertices[corners[0].vertex], obj.vertices[corners[1].vertex], obj.vertices[corners[2].vertex]};
}

/// Sums of the unit normals of the triangles at each vertex, weighted by their angles there.
std::vector<dvec3> angleWeightedNormals(const Obj& obj) {
    std::vector<dvec3> sums(obj.vertices.size(), dvec3{0});
    for (const Corners& corners : obj.triangles) {
        const std::array<dvec3, 3> points = pointsOf(obj, corners);
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 next = points[(i + 1) % 3] - points[i];
            const dvec3 previous = points[(i + 2) % 3] - points[i];
            const dvec3 normal = glm::cross(next, previous);
            const double length = glm::length(normal);
            if (length == 0) continue;
            const double angle = std::atan2(length, glm::dot(next, previous));
            sums[corners[i].vertex] += angle / length * normal;
        }
    }
    return sums;
}

/// Normals at the corners of one triangle: the file's, else those of `computed`; none if one is missing.
std::optional<std::array<vec3, 3>> normalsOf(const Obj& obj, const Corners& corners, const std::vector<dvec3>& computed) {
    std::array<vec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        if (corners[i].normal != NONE) normals[i] = obj.normals[corners[i].normal];
        else if (!computed.empty()) normals[i] = vec3{computed[corners[i].vertex]};
        else return std::nullopt;
    }
    return normals;
}

} // namespace

Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness) {
    const Obj obj = readObj(file, readText(file, mostMeshBytes, "cut it into several meshes"));
    std::vector<dvec3> computed;
    if (smoothness == Smoothness::smooth) computed = angleWeightedNormals(obj);

    Mesh mesh;
    mesh.triangles.reserve(obj.triangles.size());
    for (const Corners& corners : obj.triangles) {
        Mesh::Triangle triangle{pointsOf(obj, corners), std::nullopt};
        if (smoothness != Smoothness::flat) triangle.normals = normalsOf(obj, corners, computed);
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

} // namespace vkpm
