/// Rays against single triangles, spheres and boxes, compared with double precision.
#include "judge.h"
#include "map.h"
#include "scene/box.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

// t and the weights of b and c (Moeller & Trumbore 1997), whether it is a hit or not.
dvec3 planeHit(const TriangleCase& x) {
    const dvec3 u = dvec3(x.b) - dvec3(x.a), v = dvec3(x.c) - dvec3(x.a), d = x.direction;
    const dvec3 p = glm::cross(d, v), s = dvec3(x.origin) - dvec3(x.a), q = glm::cross(s, u);
    return dvec3{glm::dot(v, q), glm::dot(s, p), glm::dot(d, q)} / glm::dot(u, p);
}

// Neither the place of the hit nor its distance is decided by a rounding.
bool isClear(dvec3 hit, const TriangleCase& x) {
    const double edge = std::min({std::abs(hit.y), std::abs(hit.z), std::abs(1 - hit.y - hit.z)});
    const dvec3 n = glm::cross(dvec3(x.b) - dvec3(x.a), dvec3(x.c) - dvec3(x.a));
    const double grazing = std::abs(glm::dot(n, dvec3(x.direction))) / glm::length(n) / glm::length(dvec3(x.direction));
    return edge > 1e-4 && std::abs(hit.x) > 1e-4 && grazing > 0.01;
}

TEST(Intersect, TrianglesAgreeWithDoublePrecision) {
    Random random(1);
    std::vector<TriangleCase> xs;
    for (int i = 0; i < 200'000; i++) {
        const TriangleCase x{random.cube(1), random.cube(1) * std::exp2(random.between(-10, 10)), random.cube(1),
                             random.cube(1), random.cube(1)};
        xs.push_back(x);
    }
    const auto ys = map<vec3>("intersect_triangle", xs);
    int hits = 0, clear = 0;
    for (std::size_t i = 0; i < xs.size(); i++) {
        const dvec3 expected = planeHit(xs[i]);
        const double length = glm::length(dvec3(xs[i].direction));
        if (!isClear(dvec3{expected.x * length, expected.y, expected.z}, xs[i])) continue;
        clear++;
        const bool inside = expected.y > 0 && expected.z > 0 && expected.y + expected.z < 1;
        if (inside) {
            hits += expected.x > 0;
            ASSERT_NEAR(ys[i].x * length, expected.x * length, 1e-4) << i;
            ASSERT_NEAR(ys[i].y, expected.y, 1e-3) << i;
            ASSERT_NEAR(ys[i].z, expected.z, 1e-3) << i;
        } else ASSERT_EQ(ys[i].x, -1) << i;
    }
    EXPECT_GT(hits, 4'000);
    EXPECT_GT(clear, 150'000);
}

TEST(Intersect, DegenerateTrianglesAreMissed) {
    const vec3 a{0, 0, 0}, b{1, 0, 0};
    std::vector<TriangleCase> xs;
    for (const vec3 c : {a, b, vec3{0.5f, 0, 0}, vec3{2, 0, 0}})
        for (const vec3 d : {vec3{0, 0, -1}, vec3{1, 0, -1}, vec3{0, -1, -1}})
            xs.push_back({vec3{0.25f, 0, 1}, d, a, b, c});
    // And a ray within the triangle's plane.
    xs.push_back({vec3{-1, 0.25f, 0}, vec3{1, 0, 0}, a, b, vec3{0, 1, 0}});
    for (const vec3 y : map<vec3>("intersect_triangle", xs)) EXPECT_EQ(y.x, -1);
}

// A ray from a distance of ten radii that passes the centre at `pass` radii.
SphereCase passing(Random& random, double pass, double distance) {
    const dvec3 center = random.cube(10), direction = glm::normalize(dvec3(random.direction()));
    const double radius = std::exp2(random.between(-6, 6));
    const dvec3 across = glm::normalize(glm::cross(direction, dvec3(random.direction())));
    return {vec3(center + radius * (pass * across - distance * direction)), vec3(direction), vec3(center),
            float(radius)};
}

std::vector<SphereCase> withPoles(std::vector<SphereCase> xs) {
    for (SphereCase& x : xs) x.pole = poleOf(x.center, x.radius);
    return xs;
}

// The true distance of the line of a ray from the centre, in radii.
double passOf(const SphereCase& x) {
    return glm::length(glm::cross(dvec3(x.origin) - dvec3(x.center), dvec3(x.direction))) /
           glm::length(dvec3(x.direction)) / double{x.radius};
}

double radialError(const SphereCase& x, double t) {
    const dvec3 p = dvec3(x.origin) + t * dvec3(x.direction);
    return std::abs(glm::length(p - dvec3(x.center)) / double{x.radius} - 1);
}

TEST(Intersect, SpheresNearTheTangent) {
    Random random(2);
    std::vector<SphereCase> xs;
    for (int i = 0; i < 100'000; i++) xs.push_back(passing(random, 1 + random.between(-1e-3f, 1e-3f), 10));
    const auto ys = map<float>("intersect_sphere", withPoles(xs));
    for (std::size_t i = 0; i < xs.size(); i++) {
        // The line's distance is known to about ten roundings of the distance of ten radii and of the centre's
        // coordinates.
        const double pass = passOf(xs[i]), slack = 5e-6 * (1 + 1 / double{xs[i].radius});
        if (pass > 1 + slack) {
            ASSERT_EQ(ys[i], -1) << pass;
        }
        if (pass < 1 - slack) {
            ASSERT_GT(ys[i], 0) << pass;
        }
        if (ys[i] > 0) {
            ASSERT_LT(radialError(xs[i], ys[i]), 2 * slack) << pass;
        }
    }
}

TEST(Intersect, SpheresFarAway) {
    Random random(3);
    for (const double distance : {1e2, 1e4, 1e6}) {
        std::vector<SphereCase> xs;
        for (int i = 0; i < 20'000; i++) {
            SphereCase x = passing(random, 0, distance);
            const vec3 aim = x.center + random.cube(0.4f) * x.radius;
            x.direction = vec3(glm::normalize(dvec3(aim) - dvec3(x.origin)));
            xs.push_back(x);
        }
        const auto ys = map<float>("intersect_sphere", withPoles(xs));
        for (std::size_t i = 0; i < xs.size(); i++) {
            // Directions are rounded too: at 1e6 radii by a tenth of a radius, and t by as much.
            const double pass = passOf(xs[i]),
                         expected = glm::length(dvec3(xs[i].center) - dvec3(xs[i].origin)) -
                                    std::sqrt(std::max(0.0, 1 - pass * pass)) * double{xs[i].radius};
            ASSERT_GT(ys[i], 0) << pass;
            ASSERT_NEAR(ys[i] / expected, 1, 1e-6 + 1e-2 / distance) << pass;
        }
    }
}

TEST(Intersect, SpheresFromInside) {
    Random random(4);
    std::vector<SphereCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 center = random.cube(1);
        xs.push_back({center + random.cube(0.57f), random.direction() * 3.0f, center, 1});
    }
    const auto ys = map<float>("intersect_sphere", withPoles(xs));
    for (std::size_t i = 0; i < xs.size(); i++) {
        ASSERT_GT(ys[i], 0);
        ASSERT_LT(radialError(xs[i], ys[i]), 2e-6);
        ASSERT_GT(glm::dot(xs[i].origin + ys[i] * xs[i].direction - xs[i].center, xs[i].direction), 0)
            << "not the far side";
    }
}

// The ground of a room as a sphere, of up to the size of a planet: hits are as exact as those on a plane.
TEST(Intersect, SpheresLargerThanTheRoom) {
    Random random(6);
    for (const double radius : {1e2, 1e4, 1e6, 1e7}) {
        std::vector<SphereCase> xs;
        for (int i = 0; i < 20'000; i++) {
            const vec3 origin = random.cube(1) + vec3{0, 1.1f, 0},
                       direction{random.between(-1, 1), -1, random.between(-1, 1)};
            xs.push_back({origin, direction, vec3(dvec3(0, -radius, 0)), float(radius)});
        }
        const auto ys = map<float>("intersect_sphere", withPoles(xs));
        for (std::size_t i = 0; i < xs.size(); i++) {
            const dvec3 f = dvec3(xs[i].origin) + dvec3(0, radius, 0), d(xs[i].direction);
            const double a = glm::dot(d, d), b = -glm::dot(f, d),
                         c = glm::dot(dvec3(xs[i].origin), dvec3(xs[i].origin)) + 2 * radius * double{xs[i].origin.y};
            const double expected = c / (b + std::sqrt(b * b - a * c));
            ASSERT_NEAR(ys[i], expected, 3e-6 * std::max(1.0, expected)) << radius;
        }
    }
}

// From a point of the surface to a rounding the way inward ends at the other side, or at once.
TEST(Intersect, SpheresFromTheirSurface) {
    Random random(5);
    std::vector<SphereCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 n = random.direction(), d = random.direction();
        xs.push_back({2.0f * n, d, vec3(0), 2});
    }
    const auto ys = map<float>("intersect_sphere", withPoles(xs));
    for (std::size_t i = 0; i < xs.size(); i++) {
        const double chord = -glm::dot(dvec3(xs[i].origin), dvec3(xs[i].direction)) * 2;
        const bool atOnce = ys[i] == -1 || ys[i] < 1e-5 + 1e-6 / std::abs(chord);
        // A chord of length c is off by the rounding of the square of the radius over c.
        ASSERT_TRUE((atOnce && (chord < 0.1 || ys[i] > 0)) || std::abs(ys[i] - chord) < 1e-5 + 1e-6 / chord)
            << ys[i] << " " << chord;
    }
}

// A box of a few ulps about a point in double precision, flat in the directions asked for, grown by `size`.
BoxCase around(vec3 origin, vec3 direction, dvec3 point, vec3 size) {
    BoxCase x{origin, direction, vec3(point), vec3(point)};
    for (int i = 0; i < 3; i++) {
        if (double{x.low[i]} > point[i]) x.low[i] = std::nextafter(x.low[i], -INFINITY);
        if (double{x.high[i]} < point[i]) x.high[i] = std::nextafter(x.high[i], INFINITY);
        x.low[i] -= size[i];
        x.high[i] += size[i];
    }
    return x;
}

// Rays with components of zero of both signs, and boxes as flat as they can be, but where a ray would run within the
// flat box: that ray hits no triangle.
TEST(Intersect, BoxesAreNeverMissedByRaysThroughTheirPoints) {
    Random random(6);
    std::vector<BoxCase> xs;
    for (int i = 0; i < 1'000'000; i++) {
        const vec3 origin = random.cube(1) * std::exp2(random.between(-10, 10));
        vec3 direction = random.direction() * std::exp2(random.between(-10, 10)), size{0, 0, 0};
        for (int k = 0; k < 3; k++) {
            if (random.unit() < 0.2f) direction[k] = random.unit() < 0.5f ? 0.0f : -0.0f;
            if (random.unit() < 0.3f) size[k] = random.unit() * std::exp2(random.between(-10, 10));
            if (direction[k] == 0) size[k] = std::max(size[k], 1e-3f * std::abs(origin[k]));
        }
        if (direction == vec3(0)) continue;
        const double t = std::exp2(random.between(-15, 15));
        xs.push_back(around(origin, direction, dvec3(origin) + t * dvec3(direction), size));
    }
    const auto ys = map<float>("intersect_box", xs);
    for (std::size_t i = 0; i < xs.size(); i++) {
        ASSERT_TRUE(std::isfinite(ys[i])) << i;
        ASSERT_GE(ys[i], 0);
    }
}

TEST(Intersect, BoxesBesideAndBehindAreMissed) {
    Random random(7);
    std::vector<BoxCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 origin = random.cube(1), direction = random.direction(),
                   size = vec3(0.001f) + (random.cube(0.1f) + vec3(0.1f));
        const vec3 across = glm::normalize(glm::cross(direction, random.direction()));
        const float distance = glm::length(size) * 1.01f;
        xs.push_back(around(origin, direction, origin - direction * distance, size));
        xs.push_back(around(origin, direction, origin + across * distance + direction * random.between(0, 3), size));
    }
    for (const float y : map<float>("intersect_box", xs)) ASSERT_EQ(y, std::numeric_limits<float>::max());
}

TEST(Intersect, BoxesAreEnteredWhereTheyBegin) {
    const vec3 low{1, -1, -1}, high{2, 1, 1};
    const auto ys = map<float>("intersect_box", std::vector<BoxCase>{{{0, 0, 0}, {1, 0, 0}, low, high},
                                                                     {{0, 0, 0}, {0.5f, -0.0f, 0}, low, high},
                                                                     {{1.5f, 0, 0}, {1, 0, 0}, low, high},
                                                                     {{3, 0, 0}, {-1, 0, 0}, low, high},
                                                                     {{3, 0, 0}, {1, 0, 0}, low, high},
                                                                     {{0, 1.5f, 0}, {1, 0, 0}, low, high}});
    const float missed = std::numeric_limits<float>::max();
    EXPECT_EQ(ys, (std::vector<float>{1, 2, 0, 1, missed, missed}));
}

} // namespace
} // namespace vkpm
