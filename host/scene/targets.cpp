/// Parts of specular shapes and how full their spheres are.
#include "scene/targets.h"
#include "scene/bounding_sphere.h"
#include <algorithm>
#include <limits>
#include <numbers>

namespace vkpm {
using glm::dvec3;

namespace {

struct Part {
    std::span<TrianglePoints> triangles;
    Target sphere;
    double waste;
};

vec3 centroid(const TrianglePoints& t) { return (t[0] + t[1] + t[2]) / 3.0f; }

double areaOf(const TrianglePoints& t) { return glm::length(glm::cross(dvec3{t[1]} - dvec3{t[0]}, dvec3{t[2]} - dvec3{t[0]})) / 2; }

std::vector<vec3> pointsOf(std::span<const TrianglePoints> triangles) {
    std::vector<vec3> points;
    points.reserve(3 * triangles.size());
    for (const TrianglePoints& triangle : triangles) points.insert(points.end(), triangle.begin(), triangle.end());
    return points;
}

/// What splitting could save, in squared radii. A random line through a sphere of radius r crosses a surface of area A within it
/// A / (2 pi r^2) times in the mean (Crofton's formula); where that is less than once, most lines miss. Fuller spheres are
/// better left whole: parts overlap, and photons of unequal weight are noise.
double wasteOf(std::span<const TrianglePoints> triangles, const Target& sphere) {
    if (triangles.size() < 2) return 0;
    double area = 0;
    for (const TrianglePoints& triangle : triangles) area += areaOf(triangle);
    return std::max(0.0, double{sphere.radius} * sphere.radius - area / (2 * std::numbers::pi));
}

Part partOf(std::span<TrianglePoints> triangles) {
    const Target sphere = boundingSphere(pointsOf(triangles));
    return {triangles, sphere, wasteOf(triangles, sphere)};
}

/// Triangles on either side of their centre of mass, across the longest axis; in the order given if all are on one.
std::array<Part, 2> halves(std::span<TrianglePoints> triangles) {
    vec3 low{std::numeric_limits<float>::max()}, high{-low};
    dvec3 moment{0};
    double area = 0;
    for (const TrianglePoints& t : triangles) {
        low = glm::min(low, centroid(t));
        high = glm::max(high, centroid(t));
        moment += areaOf(t) * dvec3{centroid(t)};
        area += areaOf(t);
    }
    const vec3 sides = high - low;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const auto beyond = std::ranges::stable_partition(triangles, [&](const TrianglePoints& t) { return double{centroid(t)[axis]} * area < moment[axis]; });
    auto count = triangles.size() - beyond.size();
    if (count == 0 || count == triangles.size()) count = triangles.size() / 2;
    return {partOf(triangles.first(count)), partOf(triangles.subspan(count))};
}

} // namespace

std::vector<Target> targetsAround(std::span<const std::span<TrianglePoints>> shapes, std::size_t most) {
    std::vector<Part> parts;
    for (const std::span<TrianglePoints> shape : shapes) parts.push_back(partOf(shape));
    while (!parts.empty() && parts.size() < most) {
        const auto worst = std::ranges::max_element(parts, {}, &Part::waste);
        if (worst->waste == 0) break;
        const std::array<Part, 2> both = halves(worst->triangles);
        *worst = both[0];
        parts.push_back(both[1]);
    }
    std::vector<Target> targets;
    for (const Part& part : parts) targets.push_back(part.sphere);
    return targets;
}

} // namespace vkpm
