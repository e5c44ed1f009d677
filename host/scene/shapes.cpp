/// Shapes of a scene file: spheres, rectangles and meshes.
#include "scene/shapes.h"
#include "scene/bounding_sphere.h"
#include "scene/box.h"
#include "scene/emission.h"
#include "scene/materials.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace vkpm {
using glm::dvec3;

namespace {

constexpr std::size_t maxPrimitives = LEAF_FIRST; // indices of leaves have that many bits

bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Of light from all directions, the part that a lobe over a diffuse one reflects; 1 of what has no such coat.
float reflectedByCoat(const Material& material, const std::vector<float>& rests) {
    const auto mean = [&](uint row) { return rests[row * REST_ROW + REST_MEAN]; };
    if (material.kind == MATERIAL_PLASTIC) return 1 - mean(material.rest);
    if (material.kind != MATERIAL_STANDARD) return 1;
    const float none = mean(material.rest), all = mean(material.rest + 1), grazing = material.grazing,
                f = std::max({material.normalIncidence.x, material.normalIncidence.y, material.normalIncidence.z}),
                coat = grazing * (1 - none) + f * (none - all);
    return std::max(material.metallic + (1 - material.metallic) * coat, 1e-3f);
}

} // namespace

Transform readTransform(Reader& shape) {
    const auto steps = shape.find("transform");
    return steps ? Transform{*steps} : Transform{};
}

double soundArea(vec3 u, vec3 v) {
    const double area = glm::length(glm::cross(dvec3{u}, dvec3{v}));
    const double longest = std::max({glm::length(dvec3{u}), glm::length(dvec3{v}), glm::length(dvec3{v} - dvec3{u})});
    const bool sound = area > 1e-7 * longest * longest && area / 2 >= double{std::numeric_limits<float>::min()};
    return sound ? area : 0;
}

std::vector<dvec3> ShapeLoader::somePlaces(Reader shape) try {
    const Transform transform = readTransform(shape);
    if (const auto center = shape.find("center")) {
        const dvec3 reach{shape.at("radius").precise()};
        return {transform.point(center->place() - reach), transform.point(center->place() + reach)};
    }
    if (const auto corner = shape.find("corner")) {
        const auto edges = shape.at("edges").elements(2, 2, "");
        return {transform.point(corner->place()),
                transform.point(corner->place() + edges[0].place() + edges[1].place())};
    }
    const Mesh& mesh = meshOf(shape);
    if (mesh.triangles.empty()) return {};
    return {transform.point(mesh.triangles.front().points[0]), transform.point(mesh.triangles.back().points[1])};
} catch (const InputError&) {
    return {};
}

void ShapeLoader::add(Reader shape) {
    (void)shape.find("name");
    switch (shape.at("type").choice({"sphere", "rectangle", "mesh"})) {
    case 0:
        return addSphere(shape);
    case 1:
        return addRectangle(shape);
    default:
        return addMesh(shape);
    }
}

void ShapeLoader::finish() {
    scene.triangleCount = static_cast<uint>(scene.primitives.size());
    scene.primitives.insert(scene.primitives.end(), spheres.begin(), spheres.end());
    for (std::size_t i = scene.primitives.size(); i-- > 0;)
        if (const uint light = scene.primitives[i].light; light != NONE)
            scene.lights[light].primitive = static_cast<uint>(i);
    for (const Texture& texture : scene.textured.textures)
        scene.textured.sets = std::max(scene.textured.sets, texture.set + 1);
    if (coordinates[0].empty()) scene.textured.sets = 0;
    if (!scene.textured.colors.empty()) scene.textured.colors.resize(scene.triangleCount);
    if (!scene.textured.tangents.empty()) scene.textured.tangents.resize(scene.triangleCount);
    for (uint set = 0; set < scene.textured.sets; set++) {
        coordinates[set].resize(scene.triangleCount);
        scene.textured.coordinates.insert(scene.textured.coordinates.end(), coordinates[set].begin(),
                                          coordinates[set].end());
    }
    const auto warn = [&](Reader& shape, const std::string& wrong) {
        const auto name = shape.find("name");
        shape.warn(scene.warnings, name ? fmt::format("\"{}\": {}", printable(name->text(), 60), wrong) : wrong);
    };
    for (std::size_t i = scene.triangleCount; i < scene.primitives.size(); i++)
        if (isGlass(scene.materials[scene.primitives[i].material]))
            scene.glass.push_back({i, i + 1, vkpm::boxOf(scene.primitives[i], true)});
    for (std::size_t i = 0; i < glass.size(); i++) {
        auto& [shape, primitives] = glass[i];
        primitives.box = boxOf(scene, primitives);
        scene.glass.push_back(primitives);
        for (const std::string& wrong : wrongWithGlass(scene, primitives)) warn(shape, wrong);
    }
}

/// Of primitives that were added from `first` on.
void ShapeLoader::noteGlass(const Reader& shape, const Surface& surface, std::size_t first) {
    if (isGlass(scene.materials[surface.material])) glass.push_back({shape, {first, scene.primitives.size()}});
}

ShapeLoader::Surface ShapeLoader::readSurface(Reader& shape, bool mayLackMaterial) {
    Surface surface;
    const auto emission = shape.find("emission"), material = shape.find("material");
    if (emission) surface.radiance = textures.color(*emission, notNegative, surface.emission);
    if (const auto twoSided = shape.find("twoSided")) surface.twoSided = twoSided->boolean();
    if (const auto name = shape.find("name")) (void)name->text();

    if (material) surface.material = materialNamed(*material);
    else if (emission) surface.material = blackMaterial();
    else if (mayLackMaterial) surface.material = NONE;
    else (void)shape.at("material"); // which is missing
    return surface;
}

uint ShapeLoader::materialNamed(const Reader& reader) const {
    const std::string name = reader.text();
    const auto found = materials.find(name);
    if (found != materials.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, index] : materials) names.push_back(known);
    const std::string nearest = nearestWord(name, names);
    const std::string hint = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
    reader.fail(fmt::format("unknown material \"{}\"", printable(name, 60)),
                names.empty() ? "the scene has no \"materials\"" : fmt::format("{}known: {}", hint, quotedList(names)));
}

uint ShapeLoader::blackMaterial() {
    if (black == NONE) {
        black = static_cast<uint>(scene.materials.size());
        scene.materials.push_back({MATERIAL_DIFFUSE, vec3{0}, 1});
    }
    return black;
}

bool ShapeLoader::isNarrow(const Surface& surface) const { return vkpm::isNarrow(scene.materials[surface.material]); }

void ShapeLoader::addSphere(Reader& shape) {
    const dvec3 center = shape.at("center").place();
    const float radius = shape.at("radius").number(positive);
    const Transform transform = readTransform(shape);
    const Surface surface = readSurface(shape);
    shape.finish();

    const std::optional<double> scale = transform.uniformScale();
    if (!scale)
        shape.at("transform")
            .fail("found a non-uniform scale of a sphere", "scale it uniformly, or use a mesh instead");
    const double scaled = *scale * double{radius} / scene.coordinates.unit;
    const vec3 a = place(transform, center);
    const vec3 b{static_cast<float>(scaled), 0, 0};
    if (!(b.x > 0)) shape.fail("the transform shrinks the sphere to radius 0", "let it keep a radius > 0");
    const uint light = addLight(surface, LIGHT_SPHERE, a, b, vec3{0}, 4 * glm::pi<double>() * scaled * scaled);
    extendBounds(shape, a - b.x, a + b.x);
    requireRoom(shape);
    spheres.push_back(
        {a, b, poleOf(scene.coordinates.inside(transform.point(center)), scaled), surface.material, light, NONE});
    addTarget(surface, Target{a, b.x});
}

void ShapeLoader::addRectangle(Reader& shape) {
    const dvec3 corner = shape.at("corner").place();
    const Reader edgesReader = shape.at("edges");
    const std::vector<Reader> edges = edgesReader.elements(2, 2, "an array of 2 edges, [u, v]; the normal is u x v");
    const Transform transform = readTransform(shape);
    vec3 u{transform.direction(edges[0].place()) / scene.coordinates.unit};
    vec3 v{transform.direction(edges[1].place()) / scene.coordinates.unit};
    const Surface surface = readSurface(shape);
    shape.finish();

    // A mirrored rectangle keeps its outer side when its edges change places.
    const bool mirrors = transform.mirrors();
    if (mirrors) std::swap(u, v);
    const double area = soundArea(u, v);
    if (area == 0)
        edgesReader.fail("the edges span no area", "give two edges that are neither of length 0 nor parallel");
    const vec3 a = place(transform, corner);
    const vec2 atU = mirrors ? vec2{0, 1} : vec2{1, 0}, atV = mirrors ? vec2{1, 0} : vec2{0, 1};
    uvec2 parts{1, 1};
    if (surface.emission != NONE && surface.radiance != vec3{0})
        parts = partsOf({scene.textured, scene.textured.textures[surface.emission], {0, 0}, atU, atV});
    for (uint i = 0; i < parts.x; i++)
        for (uint j = 0; j < parts.y; j++) {
            std::array<vec3, 4> corners;
            std::array<vec2, 4> places;
            for (uint k = 0; k < 4; k++) { // around the part
                const float s = float(i + (k == 1 || k == 2)) / float(parts.x), t = float(j + k / 2) / float(parts.y);
                corners[k] = a;
                if (s != 0) corners[k] += s * u;
                if (t != 0) corners[k] += t * v;
                places[k] = s * atU + t * atV;
            }
            addRectanglePart(shape, surface, corners, u / float(parts.x), v / float(parts.y), places);
        }
    addTarget(surface, boundingSphere(std::array{a, a + u, a + u + v, a + v}));
    noteGlass(shape, surface, scene.primitives.size() - 2);
}

void ShapeLoader::addRectanglePart(const Reader& shape, const Surface& surface, const std::array<vec3, 4>& corners,
                                   vec3 u, vec3 v, const std::array<vec2, 4>& places) {
    const auto& [a, b, c, d] = corners;
    const uint light = addLight(surface, LIGHT_RECTANGLE, a, u, v, soundArea(u, v), {places[0], places[1], places[3]});
    addCoordinates(shape, surface, {places[0], places[1], places[2]});
    addFlat(shape, {a, b, c, surface.material, light, NONE});
    addCoordinates(shape, surface, {places[0], places[2], places[3]});
    addFlat(shape, {a, c, d, surface.material, light, NONE});
}

void ShapeLoader::requireRoom(const Reader& shape) const {
    if (scene.primitives.size() + spheres.size() >= maxPrimitives)
        shape.fail("the scene has too many primitives", fmt::format("allowed are {}", maxPrimitives));
}

/// Of the device, rounded once.
vec3 ShapeLoader::place(const Transform& transform, dvec3 point) const {
    return vec3{scene.coordinates.inside(transform.point(point))};
}

void ShapeLoader::extendBounds(const Reader& shape, vec3 low, vec3 high) {
    if (!isFinite(low) || !isFinite(high))
        shape.fail("the shape reaches beyond the range of 32-bit floats", "make it smaller or bring it nearer");
    scene.bounds.low = glm::min(scene.bounds.low, low);
    scene.bounds.high = glm::max(scene.bounds.high, high);
}

void ShapeLoader::addFlat(const Reader& shape, const Primitive& triangle) {
    requireRoom(shape);
    const auto [a, b, c] = std::array{triangle.a, triangle.b, triangle.c};
    extendBounds(shape, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
    scene.primitives.push_back(triangle);
}

/// Of flat lights with the coordinates at a, and at the ends of u and v.
uint ShapeLoader::addLight(const Surface& surface, uint kind, vec3 a, vec3 u, vec3 v, double area,
                           const TexturePlaces& coordinates) {
    if (surface.radiance == vec3{0}) return NONE;
    Light light{a, u, v, surface.radiance, kind, surface.twoSided ? 1u : 0u, static_cast<float>(area), 1};
    if (surface.emission != NONE) {
        const auto& [at, atU, atV] = coordinates;
        light.radiance = vec3{
            meanEmission({scene.textured, scene.textured.textures[surface.emission], at, atU - at, atV - at, kind})};
        if (light.radiance == vec3{0}) return NONE;
        scene.textured.lights.push_back({surface.emission, at, atU - at, atV - at});
        light.texture = static_cast<uint>(scene.textured.lights.size());
    }
    scene.lights.push_back(light);
    return static_cast<uint>(scene.lights.size() - 1);
}

void ShapeLoader::addTarget(const Surface& surface, const Target& target) {
    if (!isNarrow(surface)) return;
    const Material& material = scene.materials[surface.material];
    scene.targets.push_back(target);
    scene.targetWeights.push_back(reflectedByCoat(material, scene.rests));
}

} // namespace vkpm
