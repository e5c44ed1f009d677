/// The hierarchy: nothing is lost, boxes hold what they should, and rays find what brute force finds.
#include "host_rays.h"
#include "scene/box.h"
#include "scene/bvh.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <optional>
#include <random>

namespace vkpm {
namespace {

struct Shapes {
    std::vector<Primitive> primitives;
    uint triangleCount = 0;
};

HostHit closestOfAll(const Shapes& shapes, dvec3 origin, dvec3 direction) {
    HostHit hit;
    for (uint i = 0; i < shapes.primitives.size(); ++i) {
        const Primitive& p = shapes.primitives[i];
        updateHit(hit, intersect(origin, direction, p.a, p.b, p.c, i >= shapes.triangleCount), i);
    }
    return hit;
}

/// Calls `visit(leaf, box)` for every primitive of every leaf, with the intersection of the boxes above it, and checks
/// that leaves are listed once and in order.
void forEachLeaf(const Bvh& bvh, const std::function<void(const Leaf&, const Bounds&)>& visit) {
    uint next = 0;
    const std::function<void(uint, Bounds)> walk = [&](uint child, Bounds box) {
        if ((child & LEAF) != 0) {
            const uint first = child & LEAF_FIRST, count = ((child & ~LEAF) >> LEAF_SHIFT) + 1;
            EXPECT_EQ(first, next);
            next = first + count;
            for (uint i = first; i < next; ++i) visit(bvh.leaves.at(i), box);
            return;
        }
        const Node& node = bvh.nodes.at(child);
        const auto clipped = [&](vec3 low, vec3 high) {
            return Bounds{glm::max(low, box.low), glm::min(high, box.high)};
        };
        walk(node.left, clipped(node.leftLow, node.leftHigh));
        if (node.rightLow.x <= node.rightHigh.x) walk(node.right, clipped(node.rightLow, node.rightHigh));
    };
    constexpr float all = std::numeric_limits<float>::infinity();
    walk(0, {vec3{-all}, vec3{all}});
    EXPECT_EQ(next, bvh.leaves.size());
}

/// Every primitive must be in one leaf, and every point of it in the boxes above.
void expectNothingLost(const Shapes& shapes, const Bvh& bvh, double tolerance) {
    std::vector<std::optional<Bounds>> boxes(shapes.primitives.size());
    forEachLeaf(bvh, [&](const Leaf& leaf, const Bounds& box) {
        const Primitive& p = shapes.primitives.at(leaf.id);
        EXPECT_TRUE(leaf.a == p.a && leaf.b == p.b && leaf.c == p.c);
        EXPECT_FALSE(boxes[leaf.id]) << "primitive " << leaf.id << " is in two leaves";
        boxes[leaf.id] = box;
    });
    std::mt19937 random{3};
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    for (uint i = 0; i < shapes.primitives.size(); ++i) {
        const Primitive& p = shapes.primitives[i];
        ASSERT_TRUE(boxes[i]) << "primitive " << i << " is in no leaf";
        const Bounds& box = *boxes[i];
        for (int k = 0; k < 20; ++k) {
            double x = uniform(random), y = uniform(random);
            if (x + y > 1) x = 1 - x, y = 1 - y;
            dvec3 point = dvec3{p.a} + x * (dvec3{p.b} - dvec3{p.a}) + y * (dvec3{p.c} - dvec3{p.a});
            if (i >= shapes.triangleCount)
                point =
                    dvec3{p.a} + double{p.b.x} * glm::normalize(dvec3{normal(random), normal(random), normal(random)});
            ASSERT_TRUE(glm::all(glm::lessThanEqual(dvec3{box.low} - tolerance, point)) &&
                        glm::all(glm::lessThanEqual(point, dvec3{box.high} + tolerance)))
                << "primitive " << i;
        }
    }
}

/// The largest stack over all orders of visiting, by walking both.
uint largestStack(const Bvh& bvh, uint child, uint height) {
    if ((child & LEAF) != 0) return height;
    const Node& node = bvh.nodes[child];
    return std::max({height + 1, largestStack(bvh, node.left, height + 1), largestStack(bvh, node.right, height + 1)});
}

Primitive triangle(vec3 a, vec3 b, vec3 c) { return {a, b, c, 0, NONE, NONE}; }
Primitive sphere(vec3 center, float radius) { return {center, {radius, 0, 0}, poleOf(center, radius), 0, NONE, NONE}; }

/// Triangles, long and short, and spheres, small and large, all about the origin.
Shapes randomShapes(uint triangles, uint spheres, float scale) {
    std::mt19937 random{7};
    std::uniform_real_distribution<float> uniform{-1, 1};
    const auto vector = [&] { return vec3{uniform(random), uniform(random), uniform(random)}; };
    Shapes shapes{{}, triangles};
    for (uint i = 0; i < triangles; ++i) {
        const vec3 a = vector();
        const float size = i % 8 == 0 ? 1.0f : 0.05f;
        shapes.primitives.push_back(triangle(scale * a, scale * (a + size * vector()), scale * (a + size * vector())));
    }
    for (uint i = 0; i < spheres; ++i)
        shapes.primitives.push_back(sphere(scale * vector(), scale * (i % 8 == 0 ? 0.5f : 0.03f)));
    return shapes;
}

void expectSound(const Shapes& shapes, double scale) {
    const Bvh bvh = buildBvh(shapes.primitives, shapes.triangleCount);
    expectNothingLost(shapes, bvh, 1e-12 * scale);
    EXPECT_EQ(bvh.stackSize, largestStack(bvh, 0, 0));
    EXPECT_LE(bvh.stackSize, 64u);

    std::mt19937 random{5};
    std::uniform_real_distribution<double> uniform{-1, 1};
    for (int i = 0; i < 300; ++i) {
        const dvec3 origin = 3 * scale * dvec3{uniform(random), uniform(random), uniform(random)};
        const dvec3 aim = scale * dvec3{uniform(random), uniform(random), uniform(random)};
        const HostHit expected = closestOfAll(shapes, origin, aim - origin);
        const HostHit found = closestByTree(bvh, shapes.triangleCount, origin, aim - origin);
        ASSERT_EQ(found.t, expected.t) << "ray " << i;
        ASSERT_EQ(found.id, expected.id) << "ray " << i;
    }
}

TEST(Bvh, FindsWhatBruteForceFinds) {
    for (const float scale : {1.0f, 1e-9f, 1e12f}) {
        expectSound(randomShapes(2000, 0, scale), double{scale});
        expectSound(randomShapes(0, 500, scale), double{scale});
        expectSound(randomShapes(1000, 300, scale), double{scale});
    }
}

TEST(Bvh, HoldsFewPrimitives) {
    for (uint count = 1; count <= 20; ++count) {
        expectSound(randomShapes(count, 0, 1), 1);
        expectSound(randomShapes(0, count, 1), 1);
    }
    const Bvh one = buildBvh(randomShapes(1, 0, 1).primitives, 1);
    ASSERT_EQ(one.nodes.size(), 1u);
    EXPECT_GT(one.nodes[0].rightLow.x, one.nodes[0].rightHigh.x);
    EXPECT_EQ(one.stackSize, 1u);
}

TEST(Bvh, HoldsManyCoincidingPrimitives) {
    for (const uint count : {17u, 1000u, 20000u}) {
        Shapes same{std::vector(count, triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), count};
        expectNothingLost(same, buildBvh(same.primitives, count), 1e-12);
        Shapes spheres{std::vector(count, sphere({0, 1, 0}, 1)), 0};
        expectNothingLost(spheres, buildBvh(spheres.primitives, 0), 1e-12);
        same.primitives.insert(same.primitives.begin(), triangle({5, 5, 5}, {6, 5, 5}, {5, 6, 5}));
        same.triangleCount = count + 1;
        expectNothingLost(same, buildBvh(same.primitives, count + 1), 1e-12);
    }
}

TEST(Bvh, HoldsFlatAndUnevenScenes) {
    Shapes flat = randomShapes(1000, 0, 1);
    for (Primitive& p : flat.primitives) p.a.y = p.b.y = p.c.y = 0.1f;
    expectSound(flat, 1);

    // A tiny cluster in a huge room, spheres and triangles of all sizes about one point.
    Shapes uneven = randomShapes(200, 0, 1e-6f);
    for (int i = -18; i < 10; ++i) {
        const float size = std::ldexp(1.0f, 2 * i);
        uneven.primitives.push_back(triangle({-size, -size, 0}, {size, -size, 0}, {0, size, size}));
    }
    uneven.triangleCount = static_cast<uint>(uneven.primitives.size());
    for (int i = -18; i < 10; ++i) uneven.primitives.push_back(sphere({0, 0, 0}, std::ldexp(1.0f, 2 * i)));
    expectNothingLost(uneven, buildBvh(uneven.primitives, uneven.triangleCount), 1e-9);
}

TEST(Bvh, IsTheSameEachTime) {
    const Shapes shapes = randomShapes(3000, 300, 1);
    const Bvh one = buildBvh(shapes.primitives, shapes.triangleCount);
    const Bvh other = buildBvh(shapes.primitives, shapes.triangleCount);
    ASSERT_EQ(one.nodes.size(), other.nodes.size());
    ASSERT_EQ(one.leaves.size(), other.leaves.size());
    EXPECT_EQ(std::memcmp(one.nodes.data(), other.nodes.data(), one.nodes.size() * sizeof(Node)), 0);
    EXPECT_EQ(std::memcmp(one.leaves.data(), other.leaves.data(), one.leaves.size() * sizeof(Leaf)), 0);
}

TEST(Bvh, RefusesBoxesThatOverflow) {
    const std::vector<Primitive> wide{sphere({3e38f, 0, 0}, 1e38f)};
    EXPECT_THROW(buildBvh(wide, 0), InputError);
}

} // namespace
} // namespace vkpm
