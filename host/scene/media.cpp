/// Media within glass.
#include "scene/media.h"
#include "scene/glass.h"
#include "scene/lights.h"
#include "scene/text.h"
#include "scene/touching.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>

namespace vkpm {
namespace {

using glm::dvec3;

bool alike(const Medium& a, const Medium& b) {
    return a.attenuation == b.attenuation && a.ior == b.ior && a.spread == b.spread && a.priority == b.priority;
}

/// The index of a medium, which is added if there is none like it.
uint indexOf(std::vector<Medium>& media, const Medium& medium) {
    if (media.empty()) media.push_back({vec3{0}, 1}); // what all of it stands in
    const auto found =
        std::find_if(media.begin() + 1, media.end(), [&](const Medium& other) { return alike(medium, other); });
    if (found == media.end()) return media.push_back(medium), uint(media.size() - 1);
    return uint(found - media.begin());
}

bool asksForMedia(const Scene& scene, const Material& material) {
    if (!isGlass(material)) return false;
    const Medium& medium = scene.media[material.medium];
    return medium.attenuation != vec3{0} || medium.spread != vec2{0} || medium.priority != 0;
}

bool overlap(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThan(a.low, b.high)) && glm::all(glm::lessThan(b.low, a.high));
}

/// Whether glass lies in other glass, by boxes, and neither says what is outside of it.
bool hasGlassInGlass(const Scene& scene) {
    std::vector<Bounds> boxes;
    for (const GlassShape& shape : scene.glass)
        if (scene.materials[scene.primitives[shape.first].material].exterior == NONE) boxes.push_back(shape.box);
    std::ranges::sort(boxes, {}, [](const Bounds& box) { return box.low.x; });
    for (auto a = boxes.begin(); a != boxes.end(); ++a)
        for (auto b = a + 1; b != boxes.end() && b->low.x < a->high.x; ++b)
            if (overlap(*a, *b)) return true;
    return false;
}

/// What is outside, where only its index was given: glass that has the same one, if there is any.
void findExteriors(Scene& scene) {
    for (Material& material : scene.materials) {
        if (!isGlass(material) || material.exterior == NONE) continue;
        const auto isFilledWith = [&](uint medium) {
            return std::ranges::any_of(scene.materials,
                                       [&](const Material& m) { return isGlass(m) && m.medium == medium; });
        };
        for (uint i = 1; i < scene.media.size() && !isFilledWith(material.exterior); i++)
            if (scene.media[i].ior == scene.media[material.exterior].ior && isFilledWith(i)) material.exterior = i;
    }
}

/// Priorities become places in the order in which media count, from the last to the first.
void orderMedia(Scene& scene) {
    std::vector<Bounds> boxes(scene.media.size());
    for (const GlassShape& shape : scene.glass) {
        Bounds& box = boxes[scene.materials[scene.primitives[shape.first].material].medium];
        box = united(box, shape.box);
    }
    const auto size = [&](uint i) {
        return boxes[i].low.x > boxes[i].high.x ? 0 : glm::distance(dvec3{boxes[i].low}, dvec3{boxes[i].high});
    };
    std::vector<uint> order(scene.media.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin() + 1, order.end(), [&](uint a, uint b) {
        const uint first = scene.media[a].priority, second = scene.media[b].priority;
        if (first != second) return first < second;
        return size(a) != size(b) ? size(a) > size(b) : a < b;
    });
    for (uint place = 0; place < order.size(); place++) scene.media[order[place]].priority = place;
}

/// The solid angle of a triangle over that of all directions, negative if its normal faces the point (van Oosterom &
/// Strackee 1983, eq. 8).
double windingOf(const Primitive& p, dvec3 point) {
    const dvec3 a = dvec3{p.a} - point, b = dvec3{p.b} - point, c = dvec3{p.c} - point;
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    const double below = x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y;
    return std::atan2(glm::dot(a, glm::cross(b, c)), below) / (2 * glm::pi<double>());
}

/// A point next to a light, before its face or behind it: glass that emits has another medium there.
dvec3 pointNextTo(const Light& light, bool behind) {
    const dvec3 a{light.a}, u{light.u}, v{light.v};
    const double near = behind ? -1e-3 : 1e-3; // of its size
    if (light.kind == LIGHT_SPHERE) return a + dvec3{(1 + near) * u.x, 0, 0};
    if (light.kind != LIGHT_TRIANGLE && light.kind != LIGHT_RECTANGLE) return a;
    const dvec3 across = glm::cross(u, v); // over a side it is as long as the light is wide
    const double longest = std::max({glm::length(u), glm::length(v), glm::length(v - u)});
    return a + (u + v) / (light.kind == LIGHT_TRIANGLE ? 3.0 : 2.0) + near / longest * across;
}

/// Both sides' media of a light; that behind counts for what emits there.
struct Sides {
    uint before, behind;
    bool operator==(const Sides&) const = default;
};

Sides mediaOf(const Light& light, const MediaLocator& locator) {
    if (isEndless(light)) return {0, 0};
    const uint before = locator.at(pointNextTo(light, false));
    return {before, light.twoSided != 0 ? locator.at(pointNextTo(light, true)) : before};
}

/// Fills `lightMedia`. Of glass that emits, triangles are asked one by one only if some do not agree: each is a look at
/// all of the glass.
void findLightMedia(Scene& scene) {
    const MediaLocator locator{scene};
    std::vector<std::optional<Sides>> found(scene.lights.size());
    for (const GlassShape& shape : scene.glass) {
        std::vector<uint> lights;
        for (std::size_t i = shape.first; i < shape.end; i++)
            if (const uint light = scene.primitives[i].light; light != NONE) lights.push_back(light);
        const std::size_t step = std::max<std::size_t>(1, lights.size() / 16);
        for (std::size_t i = 0; i < lights.size(); i += step)
            found[lights[i]] = mediaOf(scene.lights[lights[i]], locator);
        const auto agrees = [&](uint light) { return !found[light] || found[light] == found[lights[0]]; };
        if (std::ranges::all_of(lights, agrees))
            for (const uint light : lights) found[light] = found[lights[0]];
    }
    for (std::size_t i = 0; i < found.size(); i++) {
        const Sides sides = found[i] ? *found[i] : mediaOf(scene.lights[i], locator);
        scene.lightMedia.insert(scene.lightMedia.end(), {sides.before, sides.behind});
    }
}

} // namespace

void fillGlass(Scene& scene, Material& material, const Medium& medium, float exteriorIor) {
    material.medium = indexOf(scene.media, medium);
    material.exterior = exteriorIor == 1 ? NONE : indexOf(scene.media, {vec3{0}, exteriorIor});
}

void findMedia(Scene& scene, const std::filesystem::path& file) {
    const bool asked = std::ranges::any_of(scene.glass, [&](const GlassShape& shape) {
        return asksForMedia(scene, scene.materials[scene.primitives[shape.first].material]);
    });
    scene.touching = touchingTriangles(scene, file);
    if (!asked && scene.touching.empty() && !hasGlassInGlass(scene)) return scene.media.clear();
    if (scene.media.size() > MAX_MEDIA)
        refuseFile(file, ": /materials", fmt::format("there are {} kinds of glass", scene.media.size() - 1),
                   fmt::format("allowed are {} where glass lies in glass or takes light away", MAX_MEDIA - 1));
    findExteriors(scene);
    orderMedia(scene);
    for (Medium& medium : scene.media)
        medium.attenuation = glm::min(medium.attenuation * static_cast<float>(scene.coordinates.unit),
                                      vec3{std::numeric_limits<float>::max()});
    for (Material& material : scene.materials)
        if (material.kind == MATERIAL_GLASS && material.alpha >= LEAST_ALPHA) material.kind = MATERIAL_ROUGH_GLASS;
    findLightMedia(scene);
}

MediaLocator::MediaLocator(const Scene& scene) : media(scene.media.size()) {
    if (media.empty()) return;
    for (uint i = 0; i < media.size(); i++) media[i].priority = scene.media[i].priority;
    for (const GlassShape& shape : scene.glass)
        for (std::size_t i = shape.first; i < shape.end; i++) {
            const Primitive& p = scene.primitives[i];
            const Material& material = scene.materials[p.material];
            const bool isSphere = i >= scene.triangleCount;
            const auto add = [&](uint medium, double sign) {
                media[medium].walls.push_back({p, isSphere, sign});
                media[medium].box = united(media[medium].box, boxOf(p, isSphere));
            };
            add(material.medium, 1);
            if (material.exterior != NONE) add(material.exterior, -1);
        }
}

uint MediaLocator::at(dvec3 point) const {
    std::vector<std::pair<uint, uint>> found; // priorities and media
    for (uint i = 1; i < media.size(); i++) {
        const Inside& inside = media[i];
        if (!(glm::all(glm::greaterThanEqual(point, dvec3{inside.box.low})) &&
              glm::all(glm::lessThanEqual(point, dvec3{inside.box.high}))))
            continue;
        double winding = 0;
        for (const Wall& wall : inside.walls)
            winding += wall.sign * (!wall.isSphere ? windingOf(wall.primitive, point)
                                    : glm::distance(dvec3{wall.primitive.a}, point) < double{wall.primitive.b.x} ? 1.0
                                                                                                                 : 0.0);
        for (int times = int(std::clamp(std::round(winding), 0.0, 4.0)); times > 0; times--)
            found.push_back({inside.priority, i});
    }
    std::ranges::sort(found, std::greater{});
    uint packed = 0;
    for (std::size_t i = 0; i < std::min(found.size(), std::size_t{4}); i++)
        packed |= found[i].second << MEDIUM_BITS * i;
    return packed;
}

} // namespace vkpm
