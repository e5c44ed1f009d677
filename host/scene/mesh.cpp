/// Triangle meshes from OBJ files, with the normals of the file or computed ones.
#include "scene/mesh.h"
#include "scene/obj_check.h"
#include "scene/reader.h"
#include "scene/scene.h"
#include <fmt/format.h>
#define TINYOBJLOADER_USE_DOUBLE // as the library is built
#include <tiny_obj_loader.h>

namespace vkpm {
using glm::dvec3;

namespace {

using Corners = std::array<tinyobj::index_t, 3>;

dvec3 elementAt(const std::vector<tinyobj::real_t>& values, int index) {
    const std::size_t first = 3 * static_cast<std::size_t>(index);
    return {values.at(first), values.at(first + 1), values.at(first + 2)};
}

/// The corners of all triangles of all objects in a file.
std::vector<Corners> triangleCorners(const tinyobj::ObjReader& obj) {
    std::vector<Corners> triangles;
    for (const tinyobj::shape_t& shape : obj.GetShapes())
        for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3)
            triangles.push_back({shape.mesh.indices[i], shape.mesh.indices[i + 1], shape.mesh.indices[i + 2]});
    return triangles;
}

std::array<dvec3, 3> pointsOf(const tinyobj::attrib_t& attributes, const Corners& corners) {
    std::array<dvec3, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = elementAt(attributes.vertices, corners[i].vertex_index);
    return points;
}

/// Sums of the unit normals of the triangles at each vertex, weighted by their angles there.
std::vector<dvec3> angleWeightedNormals(const tinyobj::attrib_t& attributes, const std::vector<Corners>& triangles) {
    std::vector<dvec3> sums(attributes.vertices.size() / 3, dvec3{0});
    for (const Corners& corners : triangles) {
        const std::array<dvec3, 3> points = pointsOf(attributes, corners);
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 next = points[(i + 1) % 3] - points[i];
            const dvec3 previous = points[(i + 2) % 3] - points[i];
            const dvec3 normal = glm::cross(next, previous);
            const double length = glm::length(normal);
            if (length == 0) continue;
            const double angle = std::atan2(length, glm::dot(next, previous));
            sums[static_cast<std::size_t>(corners[i].vertex_index)] += angle / length * normal;
        }
    }
    return sums;
}

/// Normals at the corners of one triangle: the file's, else those of `computed`; none if one is missing.
std::optional<std::array<vec3, 3>> normalsOf(const tinyobj::attrib_t& attributes, const Corners& corners,
                                             const std::vector<dvec3>& computed) {
    std::array<vec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        if (corners[i].normal_index >= 0) normals[i] = elementAt(attributes.normals, corners[i].normal_index);
        else if (!computed.empty()) normals[i] = vec3{computed[static_cast<std::size_t>(corners[i].vertex_index)]};
        else return std::nullopt;
    }
    return normals;
}

} // namespace

Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness) {
    const std::string text = readText(file);
    checkObj(file, text);

    tinyobj::ObjReaderConfig config;
    config.vertex_color = false;
    tinyobj::ObjReader obj;
    if (!obj.ParseFromString(text, "", config))
        throw InputError(
            fmt::format("{}: {}; allowed are Wavefront OBJ files of polygons", file.string(), obj.Error()));

    const tinyobj::attrib_t& attributes = obj.GetAttrib();
    const std::vector<Corners> triangles = triangleCorners(obj);
    std::vector<dvec3> computed;
    if (smoothness == Smoothness::smooth) computed = angleWeightedNormals(attributes, triangles);

    Mesh mesh;
    for (const Corners& corners : triangles) {
        Mesh::Triangle triangle{pointsOf(attributes, corners), std::nullopt};
        if (smoothness != Smoothness::flat) triangle.normals = normalsOf(attributes, corners, computed);
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

} // namespace vkpm
