/// How the photons and the queries of the benchmark are made.
#include "bench/gather.h"
#include "bench/random.h"
#include "shared_scene.h"
#include <algorithm>

namespace vkpm {
namespace {

constexpr std::size_t photonCount = 1u << 18, queryCount = 1u << 17;
constexpr double photonsPerDisc = 20;

/// Points uniformly distributed on the surfaces of a scene.
class Surface {
public:
    explicit Surface(const Scene& source) : scene(source) {
        for (uint i = 0; i < scene.primitives.size(); i++) areas.push_back(area() + areaOf(i));
    }

    double area() const { return areas.empty() ? 0 : areas.back(); }

    SurfacePoint point(Random& random) const {
        const auto found = std::ranges::upper_bound(areas, double(random.uniform()) * area());
        const uint i = std::min(uint(found - areas.begin()), uint(areas.size()) - 1);
        const Primitive& p = scene.primitives[i];
        const vec3 color = 0.5f + vec3{random.uniform(), random.uniform(), random.uniform()};
        if (isSphere(i)) {
            const vec3 normal = random.direction();
            return {p.a + p.b.x * normal, normal, color};
        }
        vec2 x{random.uniform(), random.uniform()};
        if (x.x + x.y > 1) x = 1.0f - x;
        const vec3 u = p.b - p.a, v = p.c - p.a;
        return {p.a + x.x * u + x.y * v, glm::normalize(glm::cross(u, v)), color};
    }

private:
    bool isSphere(uint i) const { return i >= scene.triangleCount; }

    double areaOf(uint i) const {
        const Primitive& p = scene.primitives[i];
        if (isSphere(i)) return 4 * glm::pi<double>() * double(p.b.x) * double(p.b.x);
        return 0.5 * double(glm::length(glm::cross(p.b - p.a, p.c - p.a)));
    }

    const Scene& scene;
    std::vector<double> areas; // sums up to and with each primitive
};

} // namespace

BenchGathers makeGathers(const Scene& scene) {
    Random random;
    const Surface surface(scene);
    BenchGathers gathers;
    for (std::size_t i = 0; i < photonCount; i++) gathers.photons.push_back(surface.point(random));
    for (std::size_t i = 0; i < queryCount; i++) {
        const SurfacePoint at = surface.point(random);
        gathers.queries.push_back({at.position, at.normal, vec3{1}, 0, 0});
    }
    gathers.radius = float(std::sqrt(photonsPerDisc * surface.area() / (glm::pi<double>() * double(photonCount))));
    return gathers;
}

} // namespace vkpm
