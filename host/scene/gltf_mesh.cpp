/// Reading of primitives, corner by corner, and of a whole file as one mesh.
#include "scene/gltf_mesh.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_nodes.h"
#include "scene/transform.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
using glm::dvec3, glm::dvec4;

namespace {

enum : uint { TRIANGLES = 4, STRIP = 5, FAN = 6 };

bool isSound(const dvec4& v) { return std::isfinite(v.x + v.y + v.z); }

/// The triangles of one primitive, with the vertices that they use.
class PrimitiveReader {
public:
    PrimitiveReader(GltfFile& from, Reader primitive, Losses& lost)
        : file{from}, place{std::move(primitive)}, losses{lost} {}

    IndexedMesh read() {
        const auto modeReader = place.find("mode");
        mode = modeReader ? modeReader->integer(0, 6) : TRIANGLES;
        Reader attributes = place.at("attributes");
        const auto position = attributes.find("POSITION"), normal = attributes.find("NORMAL");
        if (mode < TRIANGLES || !position) {
            losses.add(place, mode < TRIANGLES ? "points and lines are left out"
                                               : "a primitive without positions is left out");
            return {};
        }
        noteLosses();
        unpackDraco(file, place);
        positions.emplace(file, *position, "VEC3");
        if (normal) normals.emplace(file, *normal, "VEC3");
        if (normals && normals->count() != positions->count())
            normal->fail(fmt::format("found {} normals", normals->count()),
                         fmt::format("there are {} positions", positions->count()));
        for (std::size_t set = 0; set < 2; ++set)
            if (const auto places = attributes.find(fmt::format("TEXCOORD_{}", set))) {
                coordinates[set].emplace(file, *places, "VEC2");
                if (coordinates[set]->count() != positions->count())
                    places->fail(fmt::format("found {} texture coordinates", coordinates[set]->count()),
                                 fmt::format("there are {} positions", positions->count()));
            }
        if (const auto given = attributes.find("COLOR_0")) {
            const std::string type{
                file.referenced(*given, "accessors").at("type").choice({"VEC3", "VEC4"}) == 0 ? "VEC3" : "VEC4"};
            colors.emplace(file, *given, type);
            hasOpacity = type == "VEC4";
            if (colors->count() != positions->count())
                given->fail(fmt::format("found {} colours", colors->count()),
                            fmt::format("there are {} positions", positions->count()));
        }
        // Without normals they do not count (section 3.7.2.1).
        if (const auto given = normal ? attributes.find("TANGENT") : std::nullopt) {
            tangents.emplace(file, *given, "VEC4");
            if (tangents->count() != positions->count())
                given->fail(fmt::format("found {} tangents", tangents->count()),
                            fmt::format("there are {} positions", positions->count()));
        }
        if (const auto indices = place.find("indices")) readIndices(*indices);
        else
            for (uint i = 0; i < positions->count(); ++i) corners.push_back(i);
        readVertices();
        addTriangles();
        return std::move(mesh);
    }

private:
    void noteLosses() {
        if (place.find("targets")) losses.add(place, "morph targets are left out: the mesh has its own shape");
    }

    void readIndices(const Reader& reader) {
        const GltfAccessor indices(file, reader, "SCALAR");
        corners.reserve(indices.count());
        for (uint i = 0; i < indices.count(); ++i) {
            corners.push_back(indices.index(i));
            if (corners.back() >= positions->count())
                indices.place().fail(fmt::format("found {} at place {}", corners.back(), i),
                                     fmt::format("there are {} vertices, counted from 0", positions->count()));
        }
    }

    /// Those that corners use, which many primitives may draw from the same accessor.
    void readVertices() {
        std::vector<uint> used = corners;
        std::ranges::sort(used);
        used.erase(std::ranges::unique(used).begin(), used.end());
        if (used.size() < positions->count())
            for (uint& corner : corners)
                corner = static_cast<uint>(std::ranges::lower_bound(used, corner) - used.begin());
        mesh.vertices.reserve(used.size());
        for (const uint i : used) {
            const dvec4 point = positions->at(i);
            if (!isSound(point))
                positions->place().fail(fmt::format("position {} is not finite, and a triangle uses it", i),
                                        "allowed are three finite numbers");
            mesh.vertices.emplace_back(point);
            for (std::size_t set = 0; set < 2; ++set)
                if (coordinates[set]) {
                    const dvec4 at = coordinates[set]->at(i);
                    mesh.coordinates[set].emplace_back(at.x, 1 - at.y); // glTF's go down
                }
            if (colors) {
                const dvec4 color = colors->at(i);
                if (!isSound(color))
                    colors->place().fail(fmt::format("colour {} is not finite", i), "allowed are finite numbers");
                mesh.colors.emplace_back(glm::clamp(dvec3{color}, 0.0, 1.0));
                if (hasOpacity && color.w < 1)
                    losses.add(place, "the opacity of colours of vertices is left out"), hasOpacity = false;
            }
            if (tangents) {
                const dvec4 tangent = tangents->at(i);
                if (!isSound(tangent) || !std::isfinite(tangent.w))
                    tangents->place().fail(fmt::format("tangent {} is not finite", i),
                                           "allowed are four finite numbers");
                mesh.tangents.emplace_back(tangent);
            }
            if (!normals) continue;
            const dvec4 normal = normals->at(i);
            if (!isSound(normal))
                normals->place().fail(fmt::format("normal {} is not finite", i), "allowed are three finite numbers");
            mesh.normals.emplace_back(dvec3{normal});
        }
    }

    /// By the order of corners that section 3.7.2.1 gives.
    void addTriangles() {
        const std::size_t count = corners.size();
        if (mode == TRIANGLES && count % 3 != 0) losses.add(place, "corners that make no whole triangle are left out");
        for (std::size_t i = 0; i + 2 < count; i += mode == TRIANGLES ? 3 : 1) {
            if (mode == TRIANGLES) addTriangle(i, i + 1, i + 2);
            if (mode == STRIP) addTriangle(i, i + 1 + i % 2, i + 2 - i % 2);
            if (mode == FAN) addTriangle(i + 1, i + 2, 0);
        }
    }

    void addTriangle(std::size_t a, std::size_t b, std::size_t c) {
        const auto corner = [&](std::size_t i) {
            return IndexedMesh::Corner{corners[i], normals ? corners[i] : NONE,
                                       coordinates[0] || coordinates[1] ? corners[i] : NONE};
        };
        mesh.triangles.push_back({corner(a), corner(b), corner(c)});
    }

    GltfFile& file;
    Reader place;
    Losses& losses;
    uint mode = TRIANGLES;
    bool hasOpacity = false; // of colours, of which none was found yet
    std::optional<GltfAccessor> positions, normals, tangents, colors, coordinates[2];
    std::vector<uint> corners;
    IndexedMesh mesh;
};

const VertexColors white{vec3{1}, vec3{1}, vec3{1}};

void append(Mesh& all, const Mesh& part, const Transform& transform) {
    for (std::size_t set = 0; set < 2; ++set) {
        if (part.coordinates[set].empty()) continue;
        all.coordinates[set].resize(all.triangles.size());
        for (TexturePlaces c : part.coordinates[set]) {
            if (transform.mirrors()) std::swap(c.b, c.c);
            all.coordinates[set].push_back(c);
        }
    }
    if (!part.colors.empty()) {
        all.colors.resize(all.triangles.size(), white);
        for (VertexColors c : part.colors) {
            if (transform.mirrors()) std::swap(c.b, c.c);
            all.colors.push_back(c);
        }
    }
    if (!part.tangents.empty()) {
        all.tangents.resize(all.triangles.size());
        for (const Tangents& t : part.tangents) all.tangents.push_back(transformed(t, transform));
    }
    for (Mesh::Triangle triangle : part.triangles) {
        for (dvec3& point : triangle.points) point = transform.point(point);
        if (triangle.normals)
            for (vec3& normal : *triangle.normals) normal = vec3{transform.normal(normal)};
        if (transform.mirrors()) {
            std::swap(triangle.points[1], triangle.points[2]);
            if (triangle.normals) std::swap((*triangle.normals)[1], (*triangle.normals)[2]);
        }
        all.triangles.push_back(triangle);
    }
    for (auto& set : all.coordinates)
        if (!set.empty()) set.resize(all.triangles.size());
    if (!all.colors.empty()) all.colors.resize(all.triangles.size(), white);
    if (!all.tangents.empty()) all.tangents.resize(all.triangles.size());
}

} // namespace

Mesh readGltfPrimitive(GltfFile& file, Reader primitive, Smoothness smoothness, Losses& losses) {
    const std::filesystem::path name = primitive.path();
    return meshOf(name, PrimitiveReader{file, std::move(primitive), losses}.read(), smoothness);
}

Mesh loadGltfMesh(const std::filesystem::path& path, Smoothness smoothness) {
    GltfFile file(path);
    Losses losses;
    Mesh all;
    for (const GltfPlaced& placed : readGltfNodes(file, losses).meshes) {
        if (Transform::isSingular(placed.matrix)) {
            losses.add(placed.node, "a node that flattens its mesh is left out");
            continue;
        }
        const Reader primitives = file.referenced(placed.thing, "meshes").at("primitives");
        for (std::size_t i = 0; i < primitives.count(1, NONE, "an array of primitives"); ++i)
            append(all, readGltfPrimitive(file, primitives.element(i), smoothness, losses), Transform{placed.matrix});
    }
    losses.tell(all.warnings);
    all.files = file.files();
    return all;
}

} // namespace vkpm
