/// Triangle meshes from files of several formats, with the normals of the file or computed ones.
#include "scene/mesh.h"
#include "scene/gltf_mesh.h"
#include "scene/obj.h"
#include "scene/ply.h"
#include "scene/reader.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace vkpm {
using glm::dvec3;

namespace {

using Corners = std::array<IndexedMesh::Corner, 3>;

std::array<dvec3, 3> pointsOf(const IndexedMesh& from, const Corners& corners) {
    return {from.vertices[corners[0].vertex], from.vertices[corners[1].vertex], from.vertices[corners[2].vertex]};
}

/// Sums of the unit normals of the triangles at each vertex, weighted by their angles there.
std::vector<dvec3> angleWeightedNormals(const IndexedMesh& from) {
    std::vector<dvec3> sums(from.vertices.size(), dvec3{0});
    for (const Corners& corners : from.triangles) {
        const std::array<dvec3, 3> points = pointsOf(from, corners);
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
std::optional<std::array<vec3, 3>> normalsOf(const std::filesystem::path& file, const IndexedMesh& from,
                                             const Corners& corners, const std::vector<dvec3>& computed) {
    std::array<vec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const uint normal = corners[i].normal;
        if (normal != NONE && from.wrongNormals.contains(normal))
            refuseFile(file, from.wrongNormals.at(normal), "a normal that a face uses is not finite",
                       "allowed are three finite numbers, or \"smooth\": false, which leaves normals out");
        if (normal != NONE) normals[i] = from.normals[normal];
        else if (!computed.empty()) normals[i] = vec3{computed[corners[i].vertex]};
        else return std::nullopt;
    }
    return normals;
}

/// Of a triangle whose corners have normals.
Tangents tangentsOf(const IndexedMesh& from, const Corners& corners, const Mesh::Triangle& triangle) {
    if (!triangle.normals) return {};
    const auto& [a, b, c] = corners;
    const vec4 at[] = {from.tangents[a.vertex], from.tangents[b.vertex], from.tangents[c.vertex]};
    const dvec3 normal = glm::cross(triangle.points[1] - triangle.points[0], triangle.points[2] - triangle.points[0]);
    double side = 0; // kernels turn normals to the side of the triangle's
    for (std::size_t i = 0; i < 3; ++i)
        side += double{at[i].w} * glm::sign(glm::dot(dvec3{(*triangle.normals)[i]}, normal));
    return {vec3{at[0]}, vec3{at[1]}, vec3{at[2]}, side < 0 ? -1.0f : 1.0f};
}

} // namespace

/// What a file is: "PLY", "glTF", another format by its first bytes, or empty if it may be an OBJ file.
static std::string_view formatOf(const std::filesystem::path& file) {
    std::string begin(512, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    using namespace std::literals;
    constexpr std::pair<std::string_view, std::string_view> MAGIC[] = {{"ply\n"sv, "PLY"},
                                                                       {"ply\r"sv, "PLY"},
                                                                       {"\x1f\x8b"sv, "compressed by gzip"},
                                                                       {"PK\x03\x04"sv, "a ZIP archive"},
                                                                       {"\x28\xb5\x2f\xfd"sv, "compressed by zstd"},
                                                                       {"\xfd"
                                                                        "7zXZ"sv,
                                                                        "compressed by xz"},
                                                                       {"BZh"sv, "compressed by bzip2"},
                                                                       {"glTF"sv, "glTF"},
                                                                       {"Kaydara FBX"sv, "an FBX file"},
                                                                       {"; FBX"sv, "an FBX file"},
                                                                       {"BLENDER"sv, "a Blender file"},
                                                                       {"<?xml"sv, "an XML file (COLLADA or X3D)"},
                                                                       {"OFF\n"sv, "an OFF file"},
                                                                       {"#usda"sv, "a USD file"},
                                                                       {"PXR-USDC"sv, "a USD file"}};
    for (const auto& [magic, name] : MAGIC)
        if (begin.starts_with(magic)) return name;
    if (hasEnding(file, ".ply")) return "PLY";
    if (begin.starts_with("solid") && begin.find("facet") != begin.npos) return "an STL file";
    const std::size_t first = begin.find_first_not_of(" \t\r\n");
    if (isGltfName(file) || (first != begin.npos && begin[first] == '{')) return "glTF"; // or other JSON
    if (begin.size() < 84) return "";
    std::uint32_t triangles = 0; // of a binary STL file, which is as long as that says
    std::memcpy(&triangles, &begin[80], sizeof triangles);
    return std::filesystem::file_size(file) == 84 + 50 * std::uint64_t{triangles} ? "an STL file" : "";
}

Mesh meshOf(const std::filesystem::path& file, const IndexedMesh& from, Smoothness smoothness) {
    std::vector<dvec3> computed;
    if (smoothness == Smoothness::smooth) computed = angleWeightedNormals(from);

    Mesh mesh;
    if (from.skippedFaces > 0)
        mesh.warnings.push_back(fmt::format("{} faces have fewer than 3 corners and were left out", from.skippedFaces));
    mesh.materials = from.materialOfTriangle;
    mesh.materialNames = from.materials;
    for (const std::string& what : from.leftOut) mesh.warnings.push_back(what + " are left out");
    mesh.triangles.reserve(from.triangles.size());
    for (const Corners& corners : from.triangles) {
        Mesh::Triangle triangle{pointsOf(from, corners), std::nullopt};
        if (smoothness != Smoothness::flat) triangle.normals = normalsOf(file, from, corners, computed);
        mesh.triangles.push_back(triangle);
    }
    const auto isPlaced = [](const IndexedMesh::Corner& corner) { return corner.coordinates != NONE; };
    const bool placed = std::ranges::any_of(
        from.triangles, [&](const Corners& corners) { return std::ranges::any_of(corners, isPlaced); });
    for (std::size_t set = 0; set < 2; ++set)
        if (placed && !from.coordinates[set].empty())
            for (const Corners& corners : from.triangles) {
                const auto at = [&](const IndexedMesh::Corner& corner) {
                    return corner.coordinates == NONE ? vec2{0} : from.coordinates[set][corner.coordinates];
                };
                mesh.coordinates[set].push_back({at(corners[0]), at(corners[1]), at(corners[2])});
            }
    if (!from.tangents.empty())
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            mesh.tangents.push_back(tangentsOf(from, from.triangles[i], mesh.triangles[i]));
    if (!from.colors.empty())
        for (const Corners& corners : from.triangles)
            mesh.colors.push_back(
                {from.colors[corners[0].vertex], from.colors[corners[1].vertex], from.colors[corners[2].vertex]});
    return mesh;
}

Tangents transformed(const Tangents& tangents, const Transform& transform) {
    const auto direction = [&](vec3 tangent) {
        const dvec3 d = transform.direction(dvec3{tangent});
        const double length = glm::length(d);
        return length > 0 ? vec3{d / length} : vec3{0};
    };
    Tangents result{direction(tangents.a), direction(tangents.b), direction(tangents.c), tangents.side};
    if (!transform.mirrors()) return result;
    std::swap(result.b, result.c);
    result.side = -result.side;
    return result;
}

Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness) {
    const std::string_view format = formatOf(file);
    if (format == "glTF") return loadGltfMesh(file, smoothness);
    if (!format.empty() && format != "PLY")
        refuseFile(file, ":1", fmt::format("found {}", format),
                   "allowed is an OBJ, PLY or glTF file, uncompressed; most programs for meshes export them");
    const char* const advice = "cut it into several meshes";
    FileRead read;
    const IndexedMesh indexed = format == "PLY" ? readPly(file, readBytes(file, maxMeshBytes, advice, &read))
                                                : readObj(file, readText(file, maxMeshBytes, advice, &read));
    Mesh mesh = meshOf(file, indexed, smoothness);
    mesh.files = {read};
    return mesh;
}

} // namespace vkpm
