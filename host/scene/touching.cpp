/// Pairs of triangles in one plane, found by halving boxes.
#include "scene/touching.h"
#include "scene/box.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <utility>

namespace vkpm {
namespace {

using glm::dvec3;

struct Face {
    uint triangle;
    Bounds box;
};

Bounds boxOf(std::span<const Face> faces) {
    Bounds box;
    for (const Face& face : faces) box = united(box, face.box);
    return box;
}

/// Calls `found` with all faces of both sets whose boxes are near to each other.
template <class Found> void findNear(std::span<Face> a, std::span<Face> b, double apart, const Found& found) {
    const Bounds boxA = boxOf(a), boxB = boxOf(b);
    if (a.empty() || b.empty() || !areNear(boxA, boxB, apart)) return;
    if (a.size() * b.size() <= 64) {
        for (const Face& one : a)
            for (const Face& other : b)
                if (areNear(one.box, other.box, apart)) found(one.triangle, other.triangle);
        return;
    }
    std::span<Face>&larger = a.size() > b.size() ? a : b, &smaller = a.size() > b.size() ? b : a;
    const Bounds& box = a.size() > b.size() ? boxA : boxB;
    const vec3 sides = box.high - box.low;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const auto middle = larger.begin() + std::ptrdiff_t(larger.size() / 2);
    std::nth_element(larger.begin(), middle, larger.end(), [axis](const Face& one, const Face& other) {
        return one.box.low[axis] + one.box.high[axis] < other.box.low[axis] + other.box.high[axis];
    });
    findNear(larger.first(larger.size() / 2), smaller, apart, found);
    findNear(larger.subspan(larger.size() / 2), smaller, apart, found);
}

/// Whether all corners of a triangle are in the plane of another.
bool isInPlaneOf(const Primitive& p, const Primitive& other, double apart) {
    const dvec3 a{other.a}, normal = glm::normalize(glm::cross(dvec3{other.b} - a, dvec3{other.c} - a));
    return std::ranges::all_of(std::array{p.a, p.b, p.c},
                               [&](vec3 corner) { return std::abs(glm::dot(dvec3{corner} - a, normal)) <= apart; });
}

} // namespace

std::vector<uint> touchingTriangles(Scene& scene, const std::filesystem::path& file) {
    struct Shape {
        Bounds box;
        std::vector<Face> faces;
    };
    std::vector<Shape> shapes;
    for (const GlassShape& shape : scene.glass) {
        if (shape.first >= scene.triangleCount) continue;
        shapes.push_back({shape.box, {}});
        for (std::size_t i = shape.first; i < shape.end; i++)
            shapes.back().faces.push_back({uint(i), boxOf(scene.primitives[i], false)});
    }
    const auto saysOutside = [&](uint triangle) {
        return scene.materials[scene.primitives[triangle].material].exterior != NONE;
    };
    bool byHand = false;
    std::vector<std::pair<uint, uint>> pairs;
    for (auto one = shapes.begin(); one != shapes.end(); ++one)
        for (auto other = shapes.begin(); other != one; ++other) {
            const double apart = std::ldexp(std::max(reachOf(one->box), reachOf(other->box)), -17);
            if (!areNear(one->box, other->box, apart)) continue;
            findNear(std::span{one->faces}, std::span{other->faces}, apart, [&](uint a, uint b) {
                const Primitive &p = scene.primitives[a], &q = scene.primitives[b];
                if (!isInPlaneOf(p, q, apart) && !isInPlaneOf(q, p, apart)) return;
                if (saysOutside(a) || saysOutside(b)) byHand = true;
                else pairs.insert(pairs.end(), {{a, b}, {b, a}});
            });
        }
    if (byHand)
        scene.warnings.push_back(
            fmt::format("{}: /shapes: a face of glass that has an \"exteriorIor\" lies on other glass, "
                        "and light there takes one of the two alone; leave \"exteriorIor\" out",
                        printable(file.string(), 4096)));
    if (pairs.empty()) return {};
    std::ranges::sort(pairs);
    std::vector<uint> lists(scene.triangleCount + 1);
    for (uint triangle = 0, i = 0; triangle <= scene.triangleCount; triangle++) {
        lists[triangle] = scene.triangleCount + 1 + i;
        while (i < pairs.size() && pairs[i].first == triangle) i++;
    }
    for (const auto& [triangle, other] : pairs) lists.push_back(other);
    return lists;
}

} // namespace vkpm
