/// Edges and volumes of glass.
#include "scene/glass.h"
#include "scene/box.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
namespace {

using glm::dvec3;

struct Edge {
    std::array<vec3, 2> ends; // in an order of their own
    bool forward;             // whether the triangle has them in that order

    bool sameEnds(const Edge& other) const { return ends == other.ends; }
};

bool before(vec3 a, vec3 b) { return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z}; }

bool edgeBefore(const Edge& a, const Edge& b) {
    return a.ends[0] != b.ends[0] ? before(a.ends[0], b.ends[0]) : before(a.ends[1], b.ends[1]);
}

std::vector<Edge> edgesOf(const Scene& scene, const GlassShape& shape) {
    std::vector<Edge> edges;
    edges.reserve(3 * (shape.end - shape.first));
    for (std::size_t i = shape.first; i < shape.end; i++) {
        const Primitive& p = scene.primitives[i];
        for (const auto& [a, b] : {std::pair(p.a, p.b), std::pair(p.b, p.c), std::pair(p.c, p.a)}) {
            const bool forward = before(a, b);
            edges.push_back({forward ? std::array{a, b} : std::array{b, a}, forward});
        }
    }
    std::ranges::sort(edges, edgeBefore);
    return edges;
}

/// Edges that one triangle has alone, and how many have triangles that face different ways.
struct Seams {
    std::vector<Edge> open;
    std::size_t turned = 0;
};

Seams seamsOf(const std::vector<Edge>& edges) {
    Seams seams;
    for (auto begin = edges.begin(); begin != edges.end();) {
        const auto end = std::find_if(begin, edges.end(), [&](const Edge& edge) { return !edge.sameEnds(*begin); });
        const auto forward = std::count_if(begin, end, [](const Edge& edge) { return edge.forward; });
        if (end - begin == 1) seams.open.push_back(*begin);
        else if (2 * forward != end - begin) seams.turned++;
        begin = end;
    }
    return seams;
}

/// Squared distance of a point from a triangle (Ericson 2005, sec. 5.1.5, by regions of the plane).
double distance2(const Primitive& p, dvec3 point) {
    const dvec3 a{p.a}, u = dvec3{p.b} - a, v = dvec3{p.c} - a, d = point - a;
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), du = glm::dot(d, u),
                 dv = glm::dot(d, v);
    const double determinant = uu * vv - uv * uv, s = (vv * du - uv * dv) / determinant,
                 t = (uu * dv - uv * du) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) return glm::dot(d - s * u - t * v, d - s * u - t * v);
    const auto fromSegment = [&](dvec3 start, dvec3 along) {
        const dvec3 e = point - start,
                    rest = e - std::clamp(glm::dot(e, along) / glm::dot(along, along), 0.0, 1.0) * along;
        return glm::dot(rest, rest);
    };
    return std::min({fromSegment(a, u), fromSegment(a, v), fromSegment(a + u, v - u)});
}

/// Whether a point is on or next to a primitive outside the shape.
bool touchesOthers(const Scene& scene, const GlassShape& shape, dvec3 point, double reach) {
    for (std::size_t i = 0; i < scene.primitives.size(); i++) {
        if (i >= shape.first && i < shape.end) continue;
        const Primitive& p = scene.primitives[i];
        const bool isSphere = i >= scene.triangleCount;
        const Bounds box = boxOf(p, isSphere);
        const dvec3 outside = glm::max(glm::max(dvec3{box.low} - point, point - dvec3{box.high}), dvec3{0});
        if (glm::dot(outside, outside) > reach * reach) continue;
        if (isSphere ? std::abs(glm::distance(dvec3{p.a}, point) - double{p.b.x}) <= reach
                     : distance2(p, point) <= reach * reach)
            return true;
    }
    return false;
}

struct Measures {
    double volume = 0, area = 0; // the volume is negative if the outside is within
    double diagonal = 0;
    double reach = 0; // greatest coordinate
};

Measures measuresOf(const Scene& scene, const GlassShape& shape) {
    Measures m;
    const Bounds& box = shape.box;
    const dvec3 base{scene.primitives[shape.first].a};
    for (std::size_t i = shape.first; i < shape.end; i++) {
        const Primitive& p = scene.primitives[i];
        const dvec3 a = dvec3{p.a} - base, b = dvec3{p.b} - base, c = dvec3{p.c} - base;
        m.volume += glm::dot(a, glm::cross(b, c)) / 6;
        m.area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    m.reach = reachOf(box);
    m.diagonal = glm::distance(dvec3{box.low}, dvec3{box.high});
    return m;
}

/// Whether glass is around the shape, as about a cavity, whose walls face what is not glass.
bool isWithinGlass(const Scene& scene, const GlassShape& shape, const Bounds& box) {
    Bounds around;
    for (std::size_t i = 0; i < scene.primitives.size(); i++) {
        const Primitive& p = scene.primitives[i];
        if ((i >= shape.first && i < shape.end) || !vkpm::isGlass(scene.materials[p.material])) continue;
        around = united(around, boxOf(p, i >= scene.triangleCount));
    }
    return glm::all(glm::lessThanEqual(around.low, box.low)) && glm::all(glm::greaterThanEqual(around.high, box.high));
}

const std::size_t maxPairs = 10'000'000; // of triangles to compare

const std::size_t placesLookedAt = 64;
const double nextTo = 1e-2; // of the shape's diagonal

} // namespace

Bounds boxOf(const Scene& scene, const GlassShape& shape) {
    Bounds box;
    for (std::size_t i = shape.first; i < shape.end; i++) box = united(box, boxOf(scene.primitives[i], false));
    return box;
}

bool glassMayTouchOpaque(const Scene& scene) {
    const double apart = std::ldexp(glm::length(dvec3{scene.near.center}) + scene.near.radius,
                                    -14);     // of rays from as far as 100 times that
    std::array<std::vector<Bounds>, 2> boxes; // of opaque triangles, of glass
    std::array<Bounds, 2> about;
    for (std::size_t i = 0; i < scene.triangleCount; i++) {
        const bool isGlass = vkpm::isGlass(scene.materials[scene.primitives[i].material]);
        boxes[isGlass].push_back(boxOf(scene.primitives[i], false));
        about[isGlass] = united(about[isGlass], boxes[isGlass].back());
    }
    for (int kind : {0, 1})
        std::erase_if(boxes[kind], [&](const Bounds& box) { return !areNear(box, about[1 - kind], apart); });
    if (boxes[0].size() * boxes[1].size() > maxPairs) return true;
    return std::ranges::any_of(boxes[0], [&](const Bounds& a) {
        return std::ranges::any_of(boxes[1], [&](const Bounds& b) { return areNear(a, b, apart); });
    });
}

std::vector<std::string> wrongWithGlass(const Scene& scene, const GlassShape& shape) {
    const std::vector<Edge> edges = edgesOf(scene, shape);
    const Seams seams = seamsOf(edges);
    const Measures m = measuresOf(scene, shape);
    std::vector<std::string> wrong;

    const std::size_t step = seams.open.size() / placesLookedAt + 1;
    for (std::size_t i = 0; i < seams.open.size(); i += step) {
        const dvec3 middle = 0.5 * (dvec3{seams.open[i].ends[0]} + dvec3{seams.open[i].ends[1]});
        if (touchesOthers(scene, shape, middle, nextTo * m.diagonal)) continue;
        wrong.push_back(fmt::format("the glass is open, {} edges belong to one triangle alone, and light that enters "
                                    "does not leave again; close it, or give a sheet a thickness",
                                    seams.open.size()));
        break;
    }
    if (seams.turned > 0)
        wrong.push_back(fmt::format("triangles of the glass face different ways at {} edges, and light there enters "
                                    "what it should leave; let all face outward",
                                    seams.turned));
    if (!seams.open.empty() || seams.turned > 0) return wrong;

    if (m.volume < 0 && !isWithinGlass(scene, shape, shape.box))
        wrong.push_back(
            "the glass is inside out: its triangles face inward; turn them, or give \"exteriorIor\" what lies within");
    const double thickness = 2 * std::abs(m.volume) / m.area, least = std::ldexp(m.reach, -14);
    if (thickness < least)
        wrong.push_back(fmt::format("the glass is {:.2g} thick, and light misses one of its faces: 32-bit floats as "
                                    "far as this from the middle of the scene take at least {:.2g}; "
                                    "make it thicker, or the scene smaller",
                                    thickness * scene.coordinates.unit, least * scene.coordinates.unit));
    return wrong;
}

} // namespace vkpm
