/// How the rays of the benchmark are made.
#include "bench/random.h"
#include "bench/rays.h"
#include "scene/lights.h"
#include "shared_scene.h"

namespace vkpm {
namespace {

/// A point where a primary ray ends, moved off the surface, and the normal there, both on the viewer's side.
struct Point {
    vec3 position;
    vec3 normal;
};

Path startPath(vec3 origin, vec3 direction, uint from) { return {origin, direction, vec3{1}, 0, from, 0}; }

std::vector<Path> primaryRays(const Scene& scene, Random& random) {
    const uvec2 size = scene.settings.size;
    const Camera camera = pinholeCamera(scene.view, size);
    std::vector<Path> rays;
    for (uint y = 0; y < size.y; y++)
        for (uint x = 0; x < size.x; x++) {
            const float u = (float(x) + random.uniform()) / float(size.x),
                        v = (float(y) + random.uniform()) / float(size.y);
            const vec3 direction = camera.forward + (2 * u - 1) * camera.right + (1 - 2 * v) * camera.up;
            rays.push_back(startPath(camera.origin, glm::normalize(direction), NONE));
        }
    return rays;
}

Point pointAt(const Scene& scene, const Path& path, const Hit& hit) {
    const Primitive& p = scene.primitives[hit.primitive];
    const bool sphere = hit.primitive >= scene.triangleCount;
    const vec3 position = path.origin + hit.t * path.direction;
    const vec3 outward = glm::normalize(sphere ? position - p.a : glm::cross(p.b - p.a, p.c - p.a));
    const vec3 normal = glm::dot(outward, path.direction) > 0 ? -outward : outward;
    const vec3 reach = glm::abs(path.origin) + glm::abs(position);
    return {position + normal * (0x1p-18f * glm::dot(glm::abs(normal), reach)), normal};
}

/// A point of the area of a light, uniformly distributed.
vec3 pointOn(const Light& light, Random& random) {
    if (isEndless(light) || isDelta(light)) return light.a;
    if (light.kind == LIGHT_SPHERE) return light.a + light.u.x * random.direction();
    vec2 x{random.uniform(), random.uniform()};
    if (light.kind == LIGHT_TRIANGLE && x.x + x.y > 1) x = 1.0f - x;
    return light.a + x.x * light.u + x.y * light.v;
}

} // namespace

BenchRays makeRays(const Scene& scene, const EmbreeScene& embree) {
    Random random;
    BenchRays rays;
    rays.primary = primaryRays(scene, random);
    for (const Path& path : rays.primary) {
        const Hit hit = embree.closest(path.origin, path.direction);
        if (hit.primitive == NONE) continue;
        const Point point = pointAt(scene, path, hit);
        const vec3 cosine = point.normal + 0.9999f * random.direction();
        rays.bounce.push_back(startPath(point.position, glm::normalize(cosine), hit.primitive));
        const Light& light = scene.lights[random.below(scene.lights.size())];
        rays.shadow.push_back({point.position, hit.primitive, pointOn(light, random), vec3{1}, 0});
    }
    if (rays.bounce.empty())
        throw InputError("bench: the scene's camera sees nothing; allowed: one that sees a surface");
    return rays;
}

} // namespace vkpm
