/// Cutting of polygons: quads by a diagonal, others ear by ear.
#include "scene/triangulate.h"
#include <numeric>

namespace vkpm {
using glm::dvec2, glm::dvec3;

namespace {

dvec3 normalOf(dvec3 a, dvec3 b, dvec3 c) { return glm::cross(b - a, c - a); }

std::vector<std::array<uint, 3>> cutQuad(std::span<const dvec3> q) {
    const dvec3 across = q[2] - q[0], other = q[3] - q[1];
    const bool foldsAcross = glm::dot(normalOf(q[0], q[1], q[2]), normalOf(q[0], q[2], q[3])) < 0;
    const bool foldsOther = glm::dot(normalOf(q[0], q[1], q[3]), normalOf(q[1], q[2], q[3])) < 0;
    const bool shorter = glm::dot(across, across) < glm::dot(other, other);
    if (foldsAcross == foldsOther ? shorter : foldsOther) return {{0, 1, 2}, {0, 2, 3}};
    return {{0, 1, 3}, {1, 2, 3}};
}

/// The polygon in the plane across the largest component of its normal (Newell's), counterclockwise.
std::vector<dvec2> flattened(std::span<const dvec3> polygon) {
    dvec3 normal{0};
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) normal += normalOf(polygon[0], polygon[i], polygon[i + 1]);
    const dvec3 size = glm::abs(normal);
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<dvec2> points;
    for (const dvec3 p : polygon) points.push_back(normal[axis] < 0 ? dvec2{p[v], p[u]} : dvec2{p[u], p[v]});
    return points;
}

/// Twice the signed area of a triangle.
double area(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Clips ears off a ring of corners, going on around it from where the last one was.
class EarClipping {
public:
    explicit EarClipping(std::span<const dvec3> polygon) : points{flattened(polygon)}, ring(polygon.size()) {
        std::iota(ring.begin(), ring.end(), 0u);
    }

    std::vector<std::array<uint, 3>> run() {
        std::size_t place = 0;
        for (std::size_t tried = 0; ring.size() > 3 && tried < ring.size(); place = (place + 1) % ring.size()) {
            ++tried;
            if (!isEar(place)) continue;
            clip(place);
            place = (place + ring.size() - 1) % ring.size();
            tried = 0;
        }
        while (ring.size() >= 3) clip(1);
        return std::move(triangles);
    }

private:
    uint before(std::size_t place) const { return ring[(place + ring.size() - 1) % ring.size()]; }
    uint after(std::size_t place) const { return ring[(place + 1) % ring.size()]; }

    /// Whether the triangle of a corner and its neighbours turns left and holds no other corner.
    bool isEar(std::size_t place) const {
        const dvec2 a = points[before(place)], b = points[ring[place]], c = points[after(place)];
        if (!(area(a, b, c) > 0)) return false;
        for (const uint corner : ring) {
            const dvec2 p = points[corner];
            if (p == a || p == b || p == c) continue;
            if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
        }
        return true;
    }

    void clip(std::size_t place) {
        triangles.push_back({before(place), ring[place], after(place)});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(place));
    }

    std::vector<dvec2> points;
    std::vector<uint> ring; // corners that are left
    std::vector<std::array<uint, 3>> triangles;
};

} // namespace

std::vector<std::array<uint, 3>> triangulate(std::span<const dvec3> polygon) {
    if (polygon.size() == 3) return {{0, 1, 2}};
    return polygon.size() == 4 ? cutQuad(polygon) : EarClipping{polygon}.run();
}

} // namespace vkpm
