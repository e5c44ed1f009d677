/// Triangle meshes from OBJ files, with the normals of the file or computed ones.
#include "scene/mesh.h"
#include "scene/obj.h"
#include "scene/reader.h"
#include "scene/text.h"
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

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
std::optional<std::array<vec3, 3>> normalsOf(const std::filesystem::path& file, const Obj& obj, const Corners& corners,
                                             const std::vector<dvec3>& computed) {
    std::array<vec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const uint normal = corners[i].normal;
        if (normal != NONE && !std::isfinite(obj.normals[normal].x + obj.normals[normal].y + obj.normals[normal].z))
            refuseFile(file, fmt::format(":{}", obj.normalLines[normal]), "a normal that a face uses is not finite",
                       "allowed are three finite numbers, or \"smooth\": false, which leaves normals out");
        if (normal != NONE) normals[i] = obj.normals[normal];
        else if (!computed.empty()) normals[i] = vec3{computed[corners[i].vertex]};
        else return std::nullopt;
    }
    return normals;
}

} // namespace

/// What a file is by its first bytes, if it is no OBJ file; empty if it may be one.
static std::string_view otherFormat(const std::filesystem::path& file) {
    std::string begin(512, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    using namespace std::literals;
    constexpr std::pair<std::string_view, std::string_view> MAGIC[] = {{"ply\n"sv, "a PLY file"},
                                                                       {"ply\r"sv, "a PLY file"},
                                                                       {"\x1f\x8b"sv, "compressed by gzip"},
                                                                       {"PK\x03\x04"sv, "a ZIP archive"},
                                                                       {"\x28\xb5\x2f\xfd"sv, "compressed by zstd"},
                                                                       {"\xfd"
                                                                        "7zXZ"sv,
                                                                        "compressed by xz"},
                                                                       {"BZh"sv, "compressed by bzip2"},
                                                                       {"glTF"sv, "a GLB file"},
                                                                       {"Kaydara FBX"sv, "an FBX file"},
                                                                       {"; FBX"sv, "an FBX file"},
                                                                       {"BLENDER"sv, "a Blender file"},
                                                                       {"<?xml"sv, "an XML file (COLLADA or X3D)"},
                                                                       {"OFF\n"sv, "an OFF file"},
                                                                       {"#usda"sv, "a USD file"},
                                                                       {"PXR-USDC"sv, "a USD file"}};
    for (const auto& [magic, name] : MAGIC)
        if (begin.starts_with(magic)) return name;
    if (begin.starts_with("solid") && begin.find("facet") != begin.npos) return "an STL file";
    if (begin.starts_with('{')) return "a JSON file (glTF)";
    if (begin.size() < 84) return "";
    std::uint32_t triangles = 0; // of a binary STL file, which is as long as that says
    std::memcpy(&triangles, &begin[80], sizeof triangles);
    return std::filesystem::file_size(file) == 84 + 50 * std::uint64_t{triangles} ? "an STL file" : "";
}

Mesh loadMesh(const std::filesystem::path& file, Smoothness smoothness) {
    if (const std::string_view format = otherFormat(file); !format.empty())
        refuseFile(file, ":1", fmt::format("found {}", format),
                   "allowed is a Wavefront OBJ file, uncompressed; most programs for meshes export it");
    const Obj obj = readObj(file, readText(file, maxMeshBytes, "cut it into several meshes"));
    std::vector<dvec3> computed;
    if (smoothness == Smoothness::smooth) computed = angleWeightedNormals(obj);

    Mesh mesh;
    if (obj.skippedFaces > 0)
        mesh.warnings.push_back(fmt::format("{} faces have fewer than 3 corners and were left out", obj.skippedFaces));
    if (obj.materials.size() > 1)
        mesh.warnings.push_back(fmt::format("its faces use {} materials (usemtl {}), all get the material of the "
                                            "shape; for others cut the file into one for each",
                                            obj.materials.size(), quotedList(obj.materials)));
    mesh.triangles.reserve(obj.triangles.size());
    for (const Corners& corners : obj.triangles) {
        Mesh::Triangle triangle{pointsOf(obj, corners), std::nullopt};
        if (smoothness != Smoothness::flat) triangle.normals = normalsOf(file, obj, corners, computed);
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

} // namespace vkpm
