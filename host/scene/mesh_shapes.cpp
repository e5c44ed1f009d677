/// Shapes that are meshes.
#include "scene/bounding_sphere.h"
#include "scene/mikktspace.h"
#include "scene/shapes.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
using glm::dvec3;

/// The normal of unit length, or the triangle's own where there is none.
static vec3 unitNormal(dvec3 normal, const Primitive& triangle) {
    const double length = glm::length(normal);
    if (length > 0 && std::isfinite(length)) return vec3{normal / length};
    const dvec3 a{triangle.a};
    return vec3{glm::normalize(glm::cross(dvec3{triangle.b} - a, dvec3{triangle.c} - a))};
}

const Mesh& ShapeLoader::meshOf(Reader& shape) {
    const Reader fileReader = shape.at("file");
    Smoothness smoothness = Smoothness::fromFile;
    if (const auto smooth = shape.find("smooth"))
        smoothness = smooth->boolean() ? Smoothness::smooth : Smoothness::flat;
    const std::filesystem::path file = shape.path().parent_path() / fileReader.text();
    const auto known = meshes.find({file, smoothness});
    if (known != meshes.end()) return known->second;
    if (const std::string problem = fileProblem(file, true); !problem.empty())
        fileReader.fail(fmt::format("{}: {}", file.string(), problem),
                        "give an OBJ, PLY or glTF file, relative to the scene file");
    Mesh mesh = loadMesh(file, smoothness);
    noteFiles(scene, mesh.files);
    return meshes.emplace(std::pair{file, smoothness}, std::move(mesh)).first->second;
}

void ShapeLoader::addMesh(Reader& shape) {
    const Reader fileReader = shape.at("file");
    (void)shape.find("smooth");
    const Transform transform = readTransform(shape);
    auto byName = shape.find("materials");
    const Surface surface = readSurface(shape, byName.has_value());
    shape.finish();
    const Mesh& mesh = meshOf(shape);

    const std::size_t dropped =
        byName ? addParts(shape, *byName, mesh, transform, surface) : add(shape, mesh, transform, surface);
    if (dropped == mesh.triangles.size())
        fileReader.fail("no triangle of the mesh has an area", "give a mesh with a surface");
    for (const std::string& warning : mesh.warnings) fileReader.warn(scene.warnings, warning);
    if (!byName && mesh.materialNames.size() > 1)
        fileReader.warn(scene.warnings,
                        fmt::format("its faces use {} materials (usemtl {}), all get the material of the "
                                    "shape; \"materials\" gives them others",
                                    mesh.materialNames.size(), quotedList(mesh.materialNames)));
    if (dropped > 0)
        shape.warn(scene.warnings,
                   fmt::format("{} of {} triangles have no area and were dropped", dropped, mesh.triangles.size()));
}

/// A mesh whose faces have the materials that `byName` gives for the names in its file, others that of the shape.
std::size_t ShapeLoader::addParts(Reader& shape, Reader& byName, const Mesh& mesh, const Transform& transform,
                                  const Surface& surface) {
    std::vector<Surface> surfaces(mesh.materialNames.size(), surface);
    for (const std::string& name : byName.keys()) {
        const Reader value = byName.at(name);
        const auto found = std::ranges::find(mesh.materialNames, name);
        if (found == mesh.materialNames.end())
            value.fail(fmt::format("the mesh has no faces of a material \"{}\"", printable(name, 60)),
                       mesh.materialNames.empty() ? "it says no materials (usemtl) at all"
                                                  : "it has " + quotedList(mesh.materialNames));
        Surface& its = surfaces[std::size_t(found - mesh.materialNames.begin())];
        its.material = materialNamed(value);
    }
    std::size_t dropped = 0;
    const auto addPart = [&](const Surface& its, uint part) {
        const auto has = std::ranges::find(mesh.materials, part);
        if (has == mesh.materials.end() && !(mesh.materials.empty() && part == NONE)) return;
        if (its.material == NONE)
            shape.fail(part == NONE ? std::string{"some of its faces are of no material"}
                                    : fmt::format("\"materials\" says nothing of \"{}\"",
                                                  printable(mesh.materialNames[part], 60)),
                       "give the shape a \"material\" for what is left");
        dropped += add(shape, mesh, transform, its, mesh.materials.empty() ? std::nullopt : std::optional{part});
    };
    addPart(surface, NONE);
    for (uint part = 0; part < surfaces.size(); ++part) addPart(surfaces[part], part);
    return dropped;
}

bool ShapeLoader::isTextured(const Surface& surface) const {
    return surface.emission != NONE || scene.materials[surface.material].textures != 0;
}

uint ShapeLoader::normalMapOf(const Surface& surface) const {
    const uint textured = scene.materials[surface.material].textures;
    return textured != 0 ? scene.textured.materials[textured - 1].normal : NONE;
}

/// Those of the mesh, or computed ones, of all its triangles; none if there is no use for them.
std::vector<Tangents> ShapeLoader::tangentsFor(const Mesh& mesh, const Surface& surface) const {
    const uint normal = normalMapOf(surface);
    if (normal == NONE) return {};
    const uint set = scene.textured.textures[normal].set;
    const bool smooth = std::ranges::any_of(mesh.triangles, [](const auto& t) { return t.normals.has_value(); });
    if (!mesh.tangents.empty() || !smooth || mesh.coordinates[set].empty()) return mesh.tangents;
    return mikkTangents(mesh, set);
}

/// Before the triangle itself is added.
void ShapeLoader::addCoordinates(const Reader& shape, const Surface& surface, const TexturePlaces& first,
                                 const TexturePlaces& second) {
    if (!isTextured(surface)) return;
    for (std::size_t set = 0; set < 2; ++set) {
        const TexturePlaces& c = set == 0 ? first : second;
        if (!std::isfinite(c.a.x + c.a.y + c.b.x + c.b.y + c.c.x + c.c.y))
            shape.fail(fmt::format("triangle {} of the mesh, from 0, has texture coordinates that are not finite",
                                   scene.primitives.size()),
                       "allowed are finite numbers");
        coordinates[set].resize(scene.primitives.size());
        coordinates[set].push_back(c);
    }
}

void ShapeLoader::warnOfFlatCoordinates(const Reader& shape, const Surface& surface, std::size_t first) {
    const uint normal = normalMapOf(surface);
    if (normal == NONE) return;
    std::size_t flat = 0;
    for (std::size_t i = first; i < scene.primitives.size(); ++i) {
        const TexturePlaces& c = coordinates[scene.textured.textures[normal].set][i];
        const glm::dvec2 b = glm::dvec2{c.b} - glm::dvec2{c.a}, d = glm::dvec2{c.c} - glm::dvec2{c.a};
        flat += b.x * d.y - b.y * d.x == 0;
    }
    if (flat > 0)
        shape.warn(scene.warnings,
                   fmt::format("the texture coordinates of {} of its {} triangles span no area: its normal "
                               "map turns nothing there",
                               flat, scene.primitives.size() - first));
}

void ShapeLoader::requireCoordinates(const Reader& shape, const Mesh& mesh, const Surface& surface) {
    if (!isTextured(surface)) return;
    const uint textured = scene.materials[surface.material].textures;
    const MaterialTextures slots = textured != 0 ? scene.textured.materials[textured - 1] : noTextures;
    for (const uint slot : {slots.color, slots.metallic, slots.roughness, slots.opacity, slots.normal, slots.specular,
                            slots.specularColor, slots.transmission, surface.emission}) {
        const uint set = slot == NONE ? 0 : scene.textured.textures[slot].set;
        if (slot == NONE || !mesh.coordinates[set].empty()) continue;
        return shape.warn(scene.warnings, fmt::format("its material has a texture, but the mesh no {} coordinates: all "
                                                      "of it is at (0, 0)",
                                                      set == 0 ? "texture" : "second texture"));
    }
}

std::size_t ShapeLoader::add(const Reader& shape, const Mesh& mesh, const Transform& transform, Surface surface,
                             std::optional<uint> part) {
    if (!mesh.colors.empty()) surface.material = textures.coloredByVertices(surface.material);
    const std::size_t first = scene.primitives.size();
    requireCoordinates(shape, mesh, surface);
    const std::vector<Tangents> tangents = tangentsFor(mesh, surface);
    std::size_t count = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (part && mesh.materials[i] != *part) continue;
        addTriangle(shape, mesh, i, transform, surface, tangents.empty() ? nullptr : &tangents[i]);
        ++count;
    }
    const std::size_t dropped = count - (scene.primitives.size() - first);
    if (dropped == count) return dropped;
    warnOfFlatCoordinates(shape, surface, first);

    std::vector<vec3> points;
    for (std::size_t i = first; i < scene.primitives.size(); ++i)
        for (const vec3 point : {scene.primitives[i].a, scene.primitives[i].b, scene.primitives[i].c})
            points.push_back(point);
    addTarget(surface, boundingSphere(points));
    noteGlass(shape, surface, first);
    return dropped;
}

void ShapeLoader::addTriangle(const Reader& shape, const Mesh& mesh, std::size_t index, const Transform& transform,
                              const Surface& surface, const Tangents* tangents) {
    const Mesh::Triangle& triangle = mesh.triangles[index];
    std::array<vec3, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = place(transform, triangle.points[i]);
    std::optional<std::array<vec3, 3>> normals = triangle.normals;

    // A mirrored triangle keeps its outer side when its winding is reversed.
    if (transform.mirrors()) {
        std::swap(points[1], points[2]);
        if (normals) std::swap((*normals)[1], (*normals)[2]);
    }
    const double area = soundArea(points[1] - points[0], points[2] - points[0]) / 2;
    if (area == 0) return;
    Primitive primitive{points[0], points[1], points[2], surface.material, NONE, NONE};
    if (normals) primitive.normals = addNormals(primitive, *normals, transform);
    TexturePlaces sets[2]{};
    for (std::size_t set = 0; set < 2; ++set)
        if (!mesh.coordinates[set].empty()) sets[set] = mesh.coordinates[set][index];
    if (transform.mirrors())
        for (TexturePlaces& c : sets) std::swap(c.b, c.c);
    const uint set = surface.emission == NONE ? 0 : scene.textured.textures[surface.emission].set;
    primitive.light =
        addLight(surface, LIGHT_TRIANGLE, points[0], points[1] - points[0], points[2] - points[0], area, sets[set]);
    addCoordinates(shape, surface, sets[0], sets[1]);
    if (!mesh.colors.empty()) {
        VertexColors colors = mesh.colors[index];
        if (transform.mirrors()) std::swap(colors.b, colors.c);
        scene.textured.colors.resize(scene.primitives.size());
        scene.textured.colors.push_back(colors);
    }
    if (tangents != nullptr) {
        scene.textured.tangents.resize(scene.primitives.size());
        scene.textured.tangents.push_back(transformed(*tangents, transform));
    }
    addFlat(shape, primitive);
}

uint ShapeLoader::addNormals(const Primitive& primitive, const std::array<vec3, 3>& normals,
                             const Transform& transform) {
    scene.normals.push_back({unitNormal(transform.normal(normals[0]), primitive),
                             unitNormal(transform.normal(normals[1]), primitive),
                             unitNormal(transform.normal(normals[2]), primitive)});
    return static_cast<uint>(scene.normals.size() - 1);
}

} // namespace vkpm
