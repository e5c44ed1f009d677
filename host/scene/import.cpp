/// Reading of imported files: their options, their parts and where these stand.
#include "scene/import.h"
#include "scene/gltf_mesh.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace vkpm {
using glm::dmat3, glm::dvec3;
using nlohmann::json;

namespace {

json placeJson(dvec3 place) { return {place.x, place.y, place.z}; }

bool isFinitePlace(dvec3 v) { return std::isfinite(v.x + v.y + v.z); }

/// The middle of an element's extent: the box about all of its points.
template <class Function> void forEachPoint(const Import& import, Function&& visit) {
    for (const ImportedInstance& instance : import.instances())
        for (std::size_t i = instance.firstPart; i < instance.endPart; ++i)
            for (const Mesh::Triangle& triangle : import.parts()[i].mesh.triangles)
                for (const dvec3& point : triangle.points) visit(instance.transform.point(point));
}

} // namespace

Import::Import(Reader import) {
    std::optional<Reader> name;
    if (import.isText()) name = import;
    else {
        name = import.at("file");
        readOptions(import);
    }
    path = import.path().parent_path() / name->text();
    if (const std::string problem = fileProblem(path, true); !problem.empty())
        name->fail(fmt::format("{}: {}", path.string(), problem), "give a glTF file, relative to the scene file");
    if (!isGltfName(path))
        name->fail(name->describe(),
                   "allowed is a .gltf or .glb file; others are shapes, {\"type\": \"mesh\", \"file\": ...}");
    file = std::make_unique<GltfFile>(path);
    nodes = readGltfNodes(*file, losses);
    readParts();
    findSphere();
    noteExtensions();
}

void Import::readOptions(Reader& object) {
    if (const auto steps = object.find("transform")) outer = Transform{*steps};
    cameraWanted = object.find("camera");
    if (const auto kind = object.find("lights")) {
        const std::size_t unit = kind->choice({"standard", "unitless", "raw"});
        if (unit == 1) units = {1, 1};
        if (unit == 2) units = {1 / (4 * glm::pi<double>()), 1};
    }
    if (const auto size = object.find("lampRadius")) lampRadius = size->number(positive);
    if (const auto kind = object.find("glass")) glass = static_cast<GltfGlass>(kind->choice({"auto", "solid", "thin"}));
    object.finish();
}

void Import::readParts() {
    const auto meshes = file->root().find("meshes");
    std::vector<std::pair<std::size_t, std::size_t>> ranges(meshes ? meshes->count(0, NONE, "an array of meshes") : 0,
                                                            {1, 0});
    for (const GltfPlaced& node : nodes.meshes) {
        const Transform transform = outer.after(node.matrix);
        if (Transform::isSingular(node.matrix)) {
            losses.add(node.node, "a node that flattens its mesh is left out");
            continue;
        }
        Reader mesh = file->referenced(node.thing, "meshes");
        auto& [first, end] = ranges[node.thing.integer(0, NONE)];
        if (first > end) { // the first node that has it
            first = all.size();
            const Reader primitives = mesh.at("primitives");
            for (std::size_t i = 0; i < primitives.count(1, NONE, "an array of primitives"); ++i) {
                Reader primitive = primitives.element(i);
                Mesh triangles = readGltfPrimitive(*file, primitive, Smoothness::fromFile, losses);
                if (triangles.triangles.empty()) continue;
                const auto material = primitive.find("material");
                if (material) (void)file->referenced(*material, "materials");
                all.push_back({std::move(triangles), primitive, material ? material->integer(0, NONE) : NONE});
            }
            end = all.size();
        }
        if (first < end) placed.push_back({transform, first, end});
    }
    if (placed.empty())
        file->root().fail("the file's scene has no triangles", "a mesh of triangles is needed, at a node of the scene");
}

/// About the box of all points.
void Import::findSphere() {
    dvec3 low{INFINITY}, high{-INFINITY};
    forEachPoint(*this, [&](dvec3 point) { low = glm::min(low, point), high = glm::max(high, point); });
    center = (low + high) / 2.0;
    forEachPoint(*this, [&](dvec3 point) { radius = std::max(radius, glm::distance(center, point)); });
    if (radius == 0)
        file->root().fail("all triangles of the file's scene are points", "a mesh with a surface is needed");
    const double greatest = std::numeric_limits<float>::max();
    if (!(glm::length(center) + 1000 * radius < greatest))
        file->root().fail("the meshes reach beyond the range of 32-bit floats", "make them smaller");
}

void Import::noteExtensions() {
    const auto used = file->root().find("extensionsUsed");
    std::vector<std::string> unknown;
    for (std::size_t i = 0; used && i < used->count(0, 1000, "an array of names"); ++i)
        if (const std::string name = used->element(i).text(); !isKnownExtension(name)) unknown.push_back(name);
    if (!unknown.empty()) losses.add(*used, fmt::format("unknown extensions are left out: {}", quotedList(unknown)));
}

std::vector<dvec3> Import::somePlaces() const {
    std::vector<dvec3> places;
    for (const ImportedInstance& instance : placed)
        for (std::size_t i = instance.firstPart; i < instance.endPart; ++i) {
            const auto& triangles = all[i].mesh.triangles;
            places.push_back(instance.transform.point(triangles.front().points[0]));
            places.push_back(instance.transform.point(triangles.back().points[1]));
        }
    return places;
}

GltfMaterial Import::material(uint index, Textures& textures) {
    if (index == NONE) return defaultGltfMaterial();
    return readGltfMaterial(file->root().at("materials").element(index), glass, {*file, textures, losses}, losses);
}

std::string Import::materialName(uint index) const {
    if (index == NONE) return "";
    const auto name = file->root().at("materials").element(index).find("name");
    return name ? name->text() : "";
}

bool Import::isWanted(const GltfPlaced& camera) const {
    if (!cameraWanted) return true;
    if (!cameraWanted->isText()) return camera.thing.integer(0, NONE) == cameraWanted->integer(0, NONE);
    for (Reader named : {camera.node, file->referenced(camera.thing, "cameras")})
        if (const auto name = named.find("name"); name && name->text() == cameraWanted->text()) return true;
    return false;
}

Reader Import::camera() {
    for (const GltfPlaced& camera : nodes.cameras)
        if (isWanted(camera) && useCamera(camera)) return Reader{path, cameraJson};
    if (cameraWanted)
        cameraWanted->fail(cameraWanted->describe() + ", which is no camera of the file's scene that vkpm can take",
                           fmt::format("it has {} cameras; give the name or the index of one with a perspective",
                                       nodes.cameras.size()));
    losses.add(file->root(), "no camera: the whole is seen from the front, a little above");
    standInFront();
    return Reader{path, cameraJson};
}

/// Looks along -z of its node, y up (glTF 2.0, section 3.10).
bool Import::useCamera(const GltfPlaced& camera) {
    Reader reader = file->referenced(camera.thing, "cameras");
    if (reader.at("type").choice({"perspective", "orthographic"}) == 1) {
        losses.add(reader, "a camera without a perspective is left out");
        return false;
    }
    Reader perspective = reader.at("perspective");
    const float angle = perspective.at("yfov").number({0, glm::radians(179.0f), true});
    const auto ratio = perspective.find("aspectRatio");
    const Transform transform = outer.after(camera.matrix);
    const dvec3 origin = transform.point(dvec3{0}), forward = glm::normalize(transform.direction({0, 0, -1})),
                up = glm::normalize(transform.direction({0, 1, 0}));
    if (!isFinitePlace(origin + forward + up) || !(glm::length(glm::cross(forward, up)) > 1e-3)) {
        losses.add(camera.node, "a node that flattens its camera is left out");
        return false;
    }
    const double distance = std::max(glm::dot(center - origin, forward), radius);
    cameraJson = {{"origin", placeJson(origin)},
                  {"target", placeJson(origin + distance * forward)},
                  {"up", placeJson(up)},
                  {"fieldOfView", glm::degrees(double{angle})}};
    if (ratio) cameraAspect = ratio->number({0.001f, 1000});
    return true;
}

/// glTF's front is +z, its up +y (section 3.4); both turn with the import.
void Import::standInFront() {
    const double degrees = 40;
    const dvec3 up = glm::normalize(outer.direction({0, 1, 0}));
    const dvec3 from = glm::normalize(outer.direction(dvec3{0, 0.35, 1}));
    const double distance = radius / std::sin(glm::radians(degrees / 2));
    cameraJson = {{"origin", placeJson(center + distance * from)},
                  {"target", placeJson(center)},
                  {"up", placeJson(up)},
                  {"fieldOfView", degrees}};
}

Reader Import::lamps() {
    if (lampsJson.is_null()) {
        lampsJson = json::array();
        for (const GltfPlaced& lamp : nodes.lights) addLamp(lamp);
    }
    return Reader{path, lampsJson};
}

/// A lamp of KHR_lights_punctual, which shines along -z of its node.
void Import::addLamp(const GltfPlaced& lamp) {
    const Reader list = file->root().at("extensions").at("KHR_lights_punctual").at("lights");
    Reader light =
        list.element(lamp.thing.integer(0, static_cast<uint>(list.count(1, NONE, "an array of lights") - 1)));
    const auto colorReader = light.find("color"), intensityReader = light.find("intensity");
    const dvec3 color{colorReader ? colorReader->vector(notNegative) : vec3{1}};
    const double strength = intensityReader ? double{intensityReader->number(notNegative)} : 1;
    const std::size_t kind = light.at("type").choice({"directional", "point", "spot"});
    const Transform transform = outer.after(lamp.matrix);
    const dvec3 place = transform.point(dvec3{0}), backwards = glm::normalize(transform.direction({0, 0, 1}));
    if (color * strength == dvec3{0} || !isFinitePlace(place)) return;
    if (kind != 1 && !isFinitePlace(backwards))
        return losses.add(lamp.node, "a node that flattens its lamp is left out");
    if (kind == 0) {
        lampsJson.push_back({{"type", "sun"},
                             {"direction", placeJson(backwards)},
                             {"irradiance", placeJson(units.irradiance * strength * color)}});
        return;
    }
    json point{{"type", kind == 1 ? "point" : "spot"},
               {"position", placeJson(place)},
               {"intensity", placeJson(units.intensity * strength * color)}};
    if (lampRadius) point["radius"] = *lampRadius;
    if (kind == 2) addCones(light, -backwards, point);
    lampsJson.push_back(point);
}

/// Half angles in radians, by default 0 and a quarter of pi.
void Import::addCones(Reader& light, dvec3 direction, json& spot) const {
    const auto cones = light.find("spot");
    std::optional<Reader> inner, outer;
    if (cones) {
        Reader reader = *cones;
        inner = reader.find("innerConeAngle");
        outer = reader.find("outerConeAngle");
    }
    const float right = glm::half_pi<float>();
    const double wide = outer ? double{outer->number({0, right, true})} : glm::quarter_pi<double>();
    const double narrow = inner ? double{inner->number({0, right})} : 0;
    spot["direction"] = placeJson(direction);
    spot["outer"] = std::min(glm::degrees(wide), 90.0);
    spot["inner"] = std::min(glm::degrees(narrow), glm::degrees(wide));
}

} // namespace vkpm
