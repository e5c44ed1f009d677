/// Tangents after Mikkelsen 2008, section 3: from the coordinates of triangles, shared among fans of them.
#include "scene/mikktspace.h"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vkpm {
using glm::dvec2;
using glm::dvec3;

namespace {

/// A corner is 3 * triangle + 0, 1 or 2.
std::size_t nextCorner(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
std::size_t previousCorner(std::size_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

struct MeshCorners {
    const Mesh& mesh;
    std::size_t set;

    std::size_t count() const { return 3 * mesh.triangles.size(); }
    dvec3 point(std::size_t i) const { return mesh.triangles[i / 3].points[i % 3]; }
    dvec3 normal(std::size_t i) const { return dvec3{(*mesh.triangles[i / 3].normals)[i % 3]}; }
    dvec2 place(std::size_t i) const {
        const TexturePlaces& places = mesh.coordinates[set][i / 3];
        return dvec2{i % 3 == 0 ? places.a : i % 3 == 1 ? places.b : places.c};
    }
    /// Bits by which corners are alike; they order numbers that are none as well.
    std::array<std::uint64_t, 8> key(std::size_t i) const {
        const dvec3 p = point(i), n = normal(i);
        const dvec2 uv = place(i);
        std::array<double, 8> numbers{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
        for (double& number : numbers) number += 0.0; // -0 is 0
        return std::bit_cast<std::array<std::uint64_t, 8>>(numbers);
    }
};

/// Twice the area that the coordinates of a triangle span, with its sign; 0 if that is no number or the triangle flat.
double spannedArea(const MeshCorners& corners, std::size_t triangle) {
    if (!corners.mesh.triangles[triangle].normals) return 0;
    const dvec2 a = corners.place(3 * triangle);
    const dvec2 b = corners.place(3 * triangle + 1) - a, c = corners.place(3 * triangle + 2) - a;
    const double area = b.x * c.y - b.y * c.x;
    return std::isfinite(area) ? area : 0;
}

dvec3 unit(dvec3 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3{0};
}

/// For each corner that takes part, the number of its vertex: corners of one number are alike.
std::vector<uint> weldedVertices(const MeshCorners& corners, const std::vector<uint>& taking) {
    std::vector<uint> sorted = taking;
    std::ranges::sort(sorted, {}, [&](uint corner) { return corners.key(corner); });
    std::vector<uint> numbers(corners.count(), NONE);
    uint number = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i > 0 && corners.key(sorted[i]) != corners.key(sorted[i - 1])) ++number;
        numbers[sorted[i]] = number;
    }
    return numbers;
}

/// Sets of corners, each named by one of them.
struct Fans {
    std::vector<uint> parent;

    explicit Fans(std::size_t count) : parent(count, 0u) { std::iota(parent.begin(), parent.end(), 0u); }
    uint of(std::size_t corner) {
        uint root = static_cast<uint>(corner);
        while (parent[root] != root) root = parent[root] = parent[parent[root]];
        return root;
    }
    void join(std::size_t a, std::size_t b) {
        const uint first = of(a), second = of(b);
        parent[std::max(first, second)] = std::min(first, second);
    }
};

} // namespace

std::vector<Tangents> mikkTangents(const Mesh& mesh, std::size_t set) {
    const MeshCorners corners{mesh, set};
    std::vector<double> areas(mesh.triangles.size());
    std::vector<uint> taking;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        areas[i] = spannedArea(corners, i);
        for (uint k = 0; k < 3 && areas[i] != 0; ++k) taking.push_back(static_cast<uint>(3 * i + k));
    }

    // Triangles on both sides of an edge share the fans at its ends, if they are of one orientation.
    const std::vector<uint> vertex = weldedVertices(corners, taking);
    Fans fans(corners.count());
    using Edge = std::tuple<uint, uint, uint>; // from a vertex to another one, and the corner at the first
    std::vector<Edge> edges;
    edges.reserve(taking.size());
    for (const uint corner : taking) edges.emplace_back(vertex[corner], vertex[nextCorner(corner)], corner);
    std::ranges::sort(edges);
    for (const uint corner : taking) {
        const uint from = vertex[corner], to = vertex[previousCorner(corner)];
        const auto beside = std::ranges::lower_bound(edges, Edge{from, to, 0});
        if (beside == edges.end() || std::get<0>(*beside) != from || std::get<1>(*beside) != to) continue;
        const uint other = std::get<2>(*beside);
        if ((areas[corner / 3] > 0) == (areas[other / 3] > 0)) fans.join(corner, other);
    }

    std::vector<dvec3> sums(corners.count(), dvec3{0});
    for (const uint corner : taking) {
        const dvec3 normal = unit(corners.normal(corner)), here = corners.point(corner);
        const auto across = [&](dvec3 v) { return unit(v - glm::dot(v, normal) * normal); };
        const std::size_t first = corner - corner % 3;
        const dvec3 ab = corners.point(first + 1) - corners.point(first),
                    ac = corners.point(first + 2) - corners.point(first);
        const dvec2 b = corners.place(first + 1) - corners.place(first),
                    c = corners.place(first + 2) - corners.place(first);
        const dvec3 along = c.y * ab - b.y * ac; // times the area
        const dvec3 next = across(corners.point(nextCorner(corner)) - here);
        const dvec3 previous = across(corners.point(previousCorner(corner)) - here);
        const double angle = std::acos(std::clamp(glm::dot(next, previous), -1.0, 1.0));
        sums[fans.of(corner)] += angle * across(areas[corner / 3] > 0 ? along : -along);
    }

    std::vector<Tangents> tangents(mesh.triangles.size());
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const auto at = [&](std::size_t k) { return vec3{unit(sums[fans.of(3 * i + k)])}; };
        if (areas[i] != 0) tangents[i] = {at(0), at(1), at(2), areas[i] > 0 ? 1.0f : -1.0f};
    }
    return tangents;
}

} // namespace vkpm
