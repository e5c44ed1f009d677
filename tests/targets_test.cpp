/// Photons aimed at bounding spheres: their weighted mean is the cosine-weighted integral over the union of the cones.
#include "judge.h"
#include "scene_on_device.h"
#include <functional>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

TEST(Targets, ConeHeightIsAccurate) {
    Random random(1);
    std::vector<vec2> xs;
    for (int i = 0; i < 10'000; i++) {
        const float distance = std::exp2(random.between(-20, 20));
        xs.push_back({distance * std::exp2(random.between(-20, -0.01f)), distance * distance});
    }
    const auto ys = map<float>("cone_height", xs);
    for (std::size_t i = 0; i < xs.size(); i++) {
        const double sin2 = double{xs[i].x} * xs[i].x / double{xs[i].y};
        ASSERT_NEAR(ys[i] / (sin2 / (1 + std::sqrt(1 - sin2))), 1, 1e-6 / (1 - sin2)) << sin2;
    }
}

struct Aim {
    vec3 position{0, 0, 0};
    vec3 normal{0, 0, 1};
    std::vector<Target> targets;
};

// A function of direction that is not symmetric in anything.
double weigh(dvec3 w) { return 1 + 0.5 * w.x + 0.25 * w.y * w.z + 0.3 * w.x * w.x; }

bool covers(const Target& target, dvec3 position, dvec3 w) {
    const dvec3 d = dvec3(target.center) - position;
    const double radius2 = double{target.radius} * target.radius, along = glm::dot(d, w), distance2 = glm::dot(d, d);
    return distance2 <= radius2 || (along > 0 && distance2 - along * along <= radius2);
}

// The same integral over the hemisphere, on a grid that is uniform in solid angle. It errs at the rims of the cones
// alone, by less than 1e-4 for the scenes below.
double bruteForce(const Aim& aim, int side = 1200) {
    const dvec3 n = glm::normalize(dvec3(aim.normal)), t = glm::normalize(glm::cross(n, dvec3{0.3, 0.5, 0.8})),
                b = glm::cross(n, t);
    double sum = 0;
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++) {
            const double z = (i + 0.5) / side, phi = 2 * pi * (j + 0.5) / side, r = std::sqrt(1 - z * z);
            const dvec3 w = r * std::cos(phi) * t + r * std::sin(phi) * b + z * n;
            for (const Target& target : aim.targets)
                if (covers(target, aim.position, w)) {
                    sum += z * weigh(w);
                    break;
                }
        }
    return 2 * sum / side / side;
}

std::vector<vec4> aimed(const Aim& aim, uint count, const char* kernel = "aim_at_targets") {
    Scene scene = sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1);
    scene.targets = aim.targets;
    for (std::size_t i = 0; i < aim.targets.size(); i++) scene.targetWeights.push_back(1 / (1 + 3 * float(i)));
    scene.lit = aim.targets[0];
    const TestScene uploaded(scene);
    Random random(7);
    std::vector<AimCase> xs;
    for (uint i = 0; i < count; i++) xs.push_back({aim.position, aim.normal, random.unit2(), random.unit()});
    return map<vec4>(kernel, xs, {}, uploaded.context());
}

Mean estimate(const Aim& aim, const char* kernel = "aim_at_targets") {
    Mean mean;
    for (const vec4& y : aimed(aim, 1u << 17, kernel)) {
        const vec3 w{y};
        EXPECT_NEAR(glm::length(w), 1, 1e-5);
        EXPECT_TRUE(y.w >= 0 && std::isfinite(y.w));
        if (y.w > 0) {
            EXPECT_GT(glm::dot(w, aim.normal), 0);
        }
        mean.add(y.w * weigh(w));
    }
    return mean;
}

void expectUnbiased(const Aim& aim, const char* what, const char* kernel = "aim_at_targets") {
    const double expected = bruteForce(aim);
    const Mean mean = estimate(aim, kernel);
    EXPECT_NEAR(mean.mean(), expected, 5 * mean.error() + 2e-4 * expected + 1e-5) << what;
    EXPECT_GT(expected, 1e-3) << what;
}

TEST(Targets, MeansAreUnbiased) {
    const vec3 tilted = glm::normalize(vec3{0.4f, -0.3f, 0.8f});
    expectUnbiased({.targets = {{{1, 0, 2}, 0.8f}}}, "one");
    expectUnbiased({.normal = tilted, .targets = {{{1, 0, 2}, 0.8f}, {{1.3f, 0.2f, 2}, 0.7f}}}, "two that overlap");
    expectUnbiased({.normal = tilted, .targets = {{{1, 0, 2}, 0.8f}, {{2, 0, 4}, 0.3f}}},
                   "one behind another, wholly covered");
    expectUnbiased({.targets = {{{0.1f, 0, 0.2f}, 1}}}, "the light inside");
    expectUnbiased({.normal = tilted, .targets = {{{0.1f, 0, 0.2f}, 1}, {{1, 0, 2}, 0.8f}}},
                   "the light inside one, beside another");
    expectUnbiased({.targets = {{{0.1f, 0, 0.2f}, 1}, {{0, 0.1f, 0}, 0.5f}}}, "the light inside two");
    expectUnbiased({.targets = {{{2, 0, 0.1f}, 1}}}, "partly below the horizon");
    expectUnbiased({.targets = {{{2, 0, -0.5f}, 1}, {{-1, 1, 1}, 0.9f}, {{0, 0, -3}, 1}}},
                   "one wholly below the horizon");
    expectUnbiased({.position = {10, 20, 30}, .targets = {{{10, 20, 31.0001f}, 1}}}, "the light almost at the sphere");
}

// A light near the scene emits over its hemisphere, one far from it into the cone alone.
TEST(Targets, FarLightsAreAimedAtTheScene) {
    const vec3 tilted = glm::normalize(vec3{0.4f, -0.3f, 0.8f});
    expectUnbiased({.targets = {{{1, 0, 2}, 1.1f}}}, "far", "aim_at_lit");
    expectUnbiased({.normal = tilted, .targets = {{{10, 0, 20}, 2}}}, "farther", "aim_at_lit");
    expectUnbiased({.targets = {{{2, 0, 0.2f}, 0.9f}}}, "partly below the horizon", "aim_at_lit");
    const Aim near{.normal = tilted, .targets = {{{1, 0, 2}, 1.2f}}};
    Aim inside = near;
    inside.targets = {{{0, 0, 0}, 1}};
    const Mean mean = estimate(near, "aim_at_lit");
    EXPECT_NEAR(mean.mean(), bruteForce(inside), 5 * mean.error());
}

TEST(Targets, AHundredTargets) {
    Random random(2);
    Aim aim{.position = {0.1f, 0.2f, -0.3f}, .normal = glm::normalize(vec3{0.1f, 0.2f, 1})};
    for (int i = 0; i < 100; i++) {
        const vec3 d = random.direction();
        aim.targets.push_back({aim.position + d * random.between(1, 4), random.between(0.05f, 0.5f)});
    }
    expectUnbiased(aim, "a hundred");
}

// Solid angles down to 1e-12: the weight is the cosine over pi times the solid angle, for every sample.
TEST(Targets, SmallTargetsAreStable) {
    for (const double solidAngle : {1e-4, 1e-8, 1e-12})
        for (const float scale : {1.0f, 1e3f}) {
            const float radius = static_cast<float>(std::sqrt(solidAngle / pi) * 3) * scale;
            const Aim aim{.normal = {0, 0, 1}, .targets = {{scale * vec3{1, 2, 2}, radius}}};
            for (const vec4& y : aimed(aim, 10'000)) {
                ASSERT_LT(glm::length(vec3(y) - vec3{1, 2, 2} / 3.0f), 1.001 * std::sqrt(solidAngle / pi) + 2e-7);
                ASSERT_NEAR(y.w / (2.0 / 3 / pi * solidAngle), 1, 2e-6 + 2 * std::sqrt(solidAngle)) << solidAngle;
            }
        }
}

// A small target within a large one must not add to what the large one sends there.
TEST(Targets, DirectionsOfSeveralTargetsCountOnce) {
    const Aim one{.targets = {{{0, 0, 2}, 1}}};
    Aim many = one;
    for (int i = 0; i < 9; i++) many.targets.push_back(one.targets[0]);
    const Mean a = estimate(one), b = estimate(many);
    EXPECT_NEAR(a.mean(), b.mean(), 5 * (a.error() + b.error()));
    EXPECT_NEAR(b.mean(), bruteForce(one), 5 * b.error() + 1e-4);
}

} // namespace
} // namespace vkpm
