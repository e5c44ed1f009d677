/// Samplers: chi-square against their densities (below 5 standard deviations, p about 1e-6), and means with a closed
/// form.
#include "judge.h"
#include "map.h"
#include <gtest/gtest.h>
#include <numbers>

namespace vkpm {
namespace {

using glm::dvec3;

const uint count = 1u << 20;

TEST(Sampling, UnitCircle) {
    const uint steps = 1u << 16;
    std::vector<float> turns(steps + 1);
    for (uint i = 0; i <= steps; i++) turns[i] = static_cast<float>(i) / steps;
    const auto ys = map<vec2>("unit_circle", turns);
    for (uint i = 0; i <= steps; i++) {
        const double angle = 2 * std::numbers::pi * turns[i];
        ASSERT_NEAR(ys[i].x, std::cos(angle), 2e-7) << turns[i];
        ASSERT_NEAR(ys[i].y, std::sin(angle), 2e-7) << turns[i];
    }
}

TEST(Sampling, UniformDisc) {
    Histogram histogram(16, 16);
    for (const vec2 p : map<vec2>("uniform_disc", unitSquare(count, 1)))
        histogram.add(double{p.x} * p.x + double{p.y} * p.y, turn(p.x, p.y));
    EXPECT_LT(histogram.deviation(), 5);
}

TEST(Sampling, UniformDiscAtTheEdgesOfTheSquare) {
    const float last = 1 - 0x1p-24f;
    const std::vector<vec2> us{{0, 0}, {0, last}, {last, 0}, {last, last}, {0.5f, 0.5f}, {0.5f, 0}, {0, 0.5f}};
    const auto ys = map<vec2>("uniform_disc", us);
    for (std::size_t i = 0; i < us.size(); i++) EXPECT_NEAR(glm::length(ys[i]), i == 4 ? 0 : 1, 1e-6) << i;
}

TEST(Sampling, CosineHemisphere) {
    Histogram histogram(16, 16);
    Mean cosine;
    for (const vec3 w : map<vec3>("cosine_hemisphere", unitSquare(count, 2))) {
        histogram.add(double{w.z} * w.z, turn(w.x, w.y));
        cosine.add(w.z);
        ASSERT_NEAR(glm::length(w), 1, 1e-6);
        ASSERT_GE(w.z, 0);
    }
    EXPECT_LT(histogram.deviation(), 5);
    EXPECT_NEAR(cosine.mean(), 2.0 / 3, 5 * std::sqrt(1.0 / 18 / count));
}

TEST(Sampling, UniformSphere) {
    Histogram histogram(16, 16);
    Mean means[3];
    for (const vec3 w : map<vec3>("uniform_sphere", unitSquare(count, 3))) {
        histogram.add((1 + double{w.z}) / 2, turn(w.x, w.y));
        for (int i = 0; i < 3; i++) means[i].add(w[i]);
        ASSERT_NEAR(glm::length(w), 1, 1e-6);
    }
    EXPECT_LT(histogram.deviation(), 5);
    for (const Mean& mean : means) EXPECT_NEAR(mean.mean(), 0, 5 * std::sqrt(1.0 / 3 / count));
}

// 1 - cos from the sine, where the cosine has lost it.
double heightOf(vec3 w) {
    const double sine2 = double{w.x} * w.x + double{w.y} * w.y, cosine = std::sqrt(std::max(0.0, 1 - sine2));
    return w.z > 0 ? sine2 / (1 + cosine) : 1 + cosine;
}

TEST(Sampling, UniformCone) {
    for (const float height : {2.0f, 1.0f, 0.3f, 1e-3f, 1e-8f}) {
        std::vector<vec3> us;
        for (const vec2 u : unitSquare(count / 4, 4)) us.push_back({u, height});
        Histogram histogram(16, 16);
        Mean mean;
        for (const vec3 w : map<vec3>("uniform_cone", us)) {
            const double part = heightOf(w) / double{height};
            histogram.add(part, turn(w.x, w.y));
            mean.add(part);
            ASSERT_NEAR(glm::length(dvec3{w}), 1, 1e-6);
        }
        EXPECT_LT(histogram.deviation(), 5) << height;
        EXPECT_NEAR(mean.mean(), 0.5, 5 * std::sqrt(1.0 / 12 / double(us.size()))) << height;
    }
}

// 64 congruent triangles: an 8 x 8 grid of the weights, each cell halved by its diagonal.
TEST(Sampling, UniformTriangle) {
    Histogram histogram(8, 8);
    Mean means[2];
    for (const vec2 w : map<vec2>("uniform_triangle", unitSquare(count, 5))) {
        ASSERT_TRUE(w.x >= 0 && w.y >= 0 && w.x + w.y <= 1.0000002f);
        const float x = 8 * w.x, y = 8 * w.y;
        const int i = std::min(static_cast<int>(x), 7), j = std::min(static_cast<int>(y), 7 - i);
        const bool upper = x - float(i) + y - float(j) > 1;
        // Row j has 2 (8 - j) - 1 triangles; those before it are 64 - (8 - j)^2.
        histogram.addBin(64 - (8 - j) * (8 - j) + std::min(2 * i + upper, 2 * (8 - j) - 2));
        for (int k = 0; k < 2; k++) means[k].add(w[k]);
    }
    EXPECT_LT(histogram.deviation(), 5);
    for (const Mean& mean : means) EXPECT_NEAR(mean.mean(), 1.0 / 3, 5 * std::sqrt(1.0 / 18 / count));
}

} // namespace
} // namespace vkpm
