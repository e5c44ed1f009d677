/// Traversal: closed meshes let no ray slip through, and hits equal those of a search through all primitives.
#include "judge.h"
#include "scene_on_device.h"
#include "shared_paths.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>

namespace vkpm {
namespace {

// A sphere of triangles, subdivided from an octahedron, with vertices pushed about at random; closed, round the origin.
std::vector<Primitive> bumpySphere(int levels, float scale, uint seed) {
    std::vector<Primitive> mesh;
    for (const float x : {1.0f, -1.0f})
        for (const float y : {1.0f, -1.0f})
            for (const float z : {1.0f, -1.0f}) mesh.push_back(triangle({x, 0, 0}, {0, y, 0}, {0, 0, z}));
    for (int level = 0; level < levels; level++) {
        std::vector<Primitive> finer;
        for (const Primitive& p : mesh) {
            const vec3 ab = glm::normalize(p.a + p.b), bc = glm::normalize(p.b + p.c), ca = glm::normalize(p.c + p.a);
            for (const Primitive& part :
                 {triangle(p.a, ab, ca), triangle(ab, p.b, bc), triangle(ca, bc, p.c), triangle(ab, bc, ca)})
                finer.push_back(part);
        }
        mesh = std::move(finer);
    }
    Random random(seed);
    std::map<std::tuple<float, float, float>, float> heights;
    for (Primitive& p : mesh)
        for (vec3* v : {&p.a, &p.b, &p.c}) {
            const auto [height, _] =
                heights.try_emplace({v->x + 0.0f, v->y + 0.0f, v->z + 0.0f}, random.between(0.7f, 1));
            *v *= height->second * scale;
        }
    return mesh;
}

// Rays aimed at vertices and at points of edges.
std::vector<VectorPair> raysAtEdges(const std::vector<Primitive>& mesh, vec3 origin, int count, Random& random) {
    std::vector<VectorPair> rays;
    for (int i = 0; i < count; i++) {
        const Primitive& p = mesh[random.bits() % mesh.size()];
        const vec3 ends[] = {p.a, p.b, p.c};
        const uint first = random.bits() % 3;
        const float part = i % 4 == 0 ? 0.0f : i % 4 == 1 ? 0.5f : random.unit();
        const vec3 target = ends[first] + part * (ends[(first + 1) % 3] - ends[first]);
        rays.push_back({origin, i % 2 ? target - origin : glm::normalize(target - origin)});
    }
    return rays;
}

TEST(Traverse, ClosedMeshesAreWatertight) {
    Random random(1);
    int triangles = 0;
    for (const float scale : {1e-3f, 1.0f, 1e4f}) {
        const auto mesh = bumpySphere(5, scale, 2);
        const Scene scene = sceneOf(mesh, static_cast<uint>(mesh.size()));
        const TestScene uploaded(scene);
        for (const vec3 origin : {vec3(0), scale * vec3{0.1f, -0.2f, 0.05f}, scale * random.cube(0.2f)}) {
            const auto rays = raysAtEdges(mesh, origin, 120'000, random);
            const auto hits =
                map<Hit>("closest_hit", rays, {.hasSpheres = 0, .stackSize = scene.stackSize}, uploaded.context());
            for (std::size_t i = 0; i < hits.size(); i++) ASSERT_NE(hits[i].primitive, NONE) << scale << " " << i;
            triangles += static_cast<int>(hits.size());
        }
    }
    EXPECT_GT(triangles, 1'000'000);
}

// An axis-aligned cube: the boxes of its leaves are flat, and rays run along axes.
TEST(Traverse, CubesAreWatertight) {
    std::vector<Primitive> cube;
    for (int axis = 0; axis < 3; axis++)
        for (const float side : {-1.0f, 1.0f}) {
            vec3 n{0, 0, 0}, u{0, 0, 0}, v{0, 0, 0};
            n[axis] = side;
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
            cube.push_back(triangle(n - u - v, n + u - v, n + u + v));
            cube.push_back(triangle(n - u - v, n + u + v, n - u + v));
        }
    const Scene scene = sceneOf(cube, 12);
    const TestScene uploaded(scene);
    Random random(3);
    for (int i = 0; i < 20; i++) {
        const vec3 origin = i == 0 ? vec3(0) : random.cube(0.9f);
        auto rays = raysAtEdges(cube, origin, 5'000, random);
        for (int axis = 0; axis < 3; axis++)
            for (const float sign : {-1.0f, 1.0f})
                for (const float zero : {-0.0f, 0.0f}) {
                    vec3 d{zero, zero, zero};
                    d[axis] = sign;
                    rays.push_back({origin, d});
                }
        for (const Hit& hit :
             map<Hit>("closest_hit", rays, {.hasSpheres = 0, .stackSize = scene.stackSize}, uploaded.context()))
            ASSERT_NE(hit.primitive, NONE);
    }
}

struct Soup {
    std::vector<Primitive> primitives;
    uint triangleCount = 0;
};

Soup randomSoup(uint triangles, uint spheres, Random& random) {
    Soup soup{{}, triangles};
    for (uint i = 0; i < triangles; i++) {
        const vec3 center = random.cube(1);
        soup.primitives.push_back(
            triangle(center + random.cube(0.3f), center + random.cube(0.3f), center + random.cube(0.3f)));
    }
    for (uint i = 0; i < spheres; i++) soup.primitives.push_back(sphere(random.cube(1), random.between(0.01f, 0.3f)));
    return soup;
}

std::vector<VectorPair> randomPairs(int count, Random& random, bool directions) {
    std::vector<VectorPair> pairs;
    for (int i = 0; i < count; i++) {
        const vec3 a = random.cube(1.5f);
        pairs.push_back({a, directions ? random.direction() : random.cube(1.5f)});
    }
    return pairs;
}

// The primitives alone, through the same functions of the device: [primitive * rays + ray].
std::vector<float> allDistances(const Soup& soup, const std::vector<VectorPair>& rays) {
    std::vector<TriangleCase> triangles;
    std::vector<SphereCase> spheres;
    for (uint i = 0; i < soup.primitives.size(); i++)
        for (const VectorPair& ray : rays) {
            const Primitive& p = soup.primitives[i];
            if (i < soup.triangleCount) triangles.push_back({ray.a, ray.b, p.a, p.b, p.c});
            else spheres.push_back({ray.a, ray.b, p.a, p.b.x, p.c});
        }
    std::vector<float> distances;
    if (!triangles.empty())
        for (const vec3 y : map<vec3>("intersect_triangle", triangles)) distances.push_back(y.x);
    if (!spheres.empty())
        for (const float y : map<float>("intersect_sphere", spheres)) distances.push_back(y);
    return distances;
}

void expectSameAsAll(const Soup& soup, const Features& features, uint seed) {
    Random random(seed);
    Scene scene = sceneOf(soup.primitives, soup.triangleCount);
    const TestScene uploaded(scene);
    Features has = features;
    has.stackSize = scene.stackSize;
    const auto rays = randomPairs(4'000, random, true), pairs = randomPairs(4'000, random, false);
    const auto hits = map<Hit>("closest_hit", rays, has, uploaded.context());
    const auto hidden = map<uint>("occlusion", pairs, has, uploaded.context());
    auto ends = pairs;
    for (VectorPair& pair : ends) pair.b -= pair.a;
    const auto distances = allDistances(soup, rays), between = allDistances(soup, ends);
    int found = 0, blocked = 0;
    for (std::size_t i = 0; i < rays.size(); i++) {
        Hit expected{std::numeric_limits<float>::max(), NONE, vec2(0)};
        bool blocks = false;
        for (uint p = 0; p < soup.primitives.size(); p++) {
            if (distances[p * rays.size() + i] > 0 && distances[p * rays.size() + i] < expected.t)
                expected = {distances[p * rays.size() + i], p, vec2(0)};
            blocks |= between[p * rays.size() + i] > 0 && between[p * rays.size() + i] < 1;
        }
        ASSERT_EQ(hits[i].primitive, expected.primitive) << i;
        ASSERT_EQ(hits[i].t, expected.t) << i;
        ASSERT_EQ(hidden[i], blocks) << i;
        found += expected.primitive != NONE;
        blocked += blocks;
    }
    EXPECT_GT(found, 400);
    EXPECT_GT(blocked, 300);
    EXPECT_LT(blocked, 3'700);
}

TEST(Traverse, HitsEqualThoseOfASearchThroughAll) {
    Random random(4);
    expectSameAsAll(randomSoup(50, 50, random), {}, 5);
    expectSameAsAll(randomSoup(100, 0, random), {.hasSpheres = 0}, 6);
    expectSameAsAll(randomSoup(0, 50, random), {.hasTriangles = 0}, 7);
}

// A ray leaves out the triangle that it starts on, but not the sphere, whose other side it may meet.
TEST(Traverse, RaysDoNotHitTheTriangleTheyLeave) {
    const Scene scene = sceneOf({triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}),
                                 triangle({-1, -1, -1}, {1, -1, -1}, {0, 1, -1}), sphere({0, 0, -3}, 1)},
                                2);
    const TestScene uploaded(scene);
    const vec3 down{0, 0, -1};
    const std::vector<StartCase> rays{
        {{0, 0, 1}, down, NONE}, {{0, 0, 1}, down, 0}, {{0, 0, 1}, down, 1}, {{0, 0, -3}, down, 2}};
    const auto hits = map<Hit>("closest_from", rays, {.stackSize = scene.stackSize}, uploaded.context());
    for (std::size_t i = 0; i < rays.size(); i++) EXPECT_EQ(hits[i].primitive, (std::vector<uint>{0, 1, 0, 2})[i]) << i;
}

// Of two primitives at the same distance the lower one is hit.
TEST(Traverse, TiesGoToTheLowerPrimitive) {
    const Primitive t = triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    const Scene scene = sceneOf(std::vector<Primitive>(40, t), 40);
    const TestScene uploaded(scene);
    const auto hits = map<Hit>("closest_hit", std::vector<VectorPair>{{{0, 0, 1}, {0, 0, -1}}, {{0, 0, -1}, {0, 0, 2}}},
                               {.stackSize = scene.stackSize}, uploaded.context());
    for (const Hit& hit : hits) EXPECT_EQ(hit.primitive, 0u);
    EXPECT_EQ(hits[1].t, 0.5f);
}

// A square at a height over a tilted plane, halved along one of its diagonals.
std::vector<Primitive> square(float side, float height, bool otherDiagonal, uint material) {
    const vec3 n = glm::normalize(vec3{0.2f, 0.9f, -0.3f}), t = glm::normalize(glm::cross(n, vec3{1, 0, 0})),
               b = glm::cross(n, t), middle = vec3{3, -2, 5} + height * n;
    std::array<vec3, 4> c{middle - side * (t + b), middle + side * (t - b), middle + side * (t + b),
                          middle - side * (t - b)};
    if (otherDiagonal) std::ranges::rotate(c, c.begin() + 1);
    return {{c[0], c[1], c[2], material, NONE, NONE}, {c[0], c[2], c[3], material, NONE, NONE}};
}

// Whichever comes first in the scene, rays from either side hit the opaque one of two faces at one place, and what
// leaves it does not hit the glass.
TEST(Traverse, OpaqueFacesHideTheGlassThatTouchesThem) {
    Random random(8);
    const uint opaque = 0, glass = 1;
    for (const bool glassFirst : {false, true})
        for (const float height : {0.0f, 1e-7f, -1e-6f, 1e-2f}) {
            auto mesh = square(1, 0, false, opaque);
            const auto cover = square(1.7f, height, true, glass);
            mesh.insert(glassFirst ? mesh.begin() : mesh.end(), cover.begin(), cover.end());
            Scene scene = sceneOf(mesh, 4);
            scene.materials.push_back({MATERIAL_GLASS, vec3{1}, 1.5f});
            const TestScene uploaded(scene);
            const vec3 n = glm::normalize(vec3{0.2f, 0.9f, -0.3f});
            const uint opaqueId = glassFirst ? 2 : 0;
            std::vector<StartCase> toward, away;
            for (int i = 0; i < 20'000; i++) {
                const Primitive& p = mesh[opaqueId + i % 2];
                const vec2 u = random.unit2();
                const float s = std::sqrt(u.x);
                const vec3 place = (1 - s) * p.a + s * (1 - u.y) * p.b + s * u.y * p.c;
                vec3 w = random.direction();
                if (glm::dot(w, n) < 0) w = -w;
                if (glm::dot(w, n) < 0.02f) continue; // or they pass the cover by
                toward.push_back({place + 2.0f * w, -w, NONE});
                away.push_back({place, w, opaqueId + i % 2});
            }
            const auto found = map<Hit>("closest_from", toward, {.stackSize = scene.stackSize}, uploaded.context());
            const auto left = map<Hit>("closest_from", away, {.stackSize = scene.stackSize}, uploaded.context());
            const bool touches = height < 1e-3f;
            for (std::size_t i = 0; i < found.size(); i++) {
                ASSERT_EQ(mesh[found[i].primitive].material, touches ? opaque : glass) << height << " " << i;
                if (touches) {
                    ASSERT_EQ(left[i].primitive, NONE) << height << " " << i;
                }
            }
        }
}

} // namespace
} // namespace vkpm
