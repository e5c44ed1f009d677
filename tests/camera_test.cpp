/// Camera directions, and the small functions that every kernel has.
#include "judge.h"
#include "map.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

TEST(Camera, DirectionsThroughTheFilm) {
    const Camera camera{.origin = {5, 5, 5}, .forward = {0, 0, -1}, .right = {0.5f, 0, 0}, .up = {0, 0.25f, 0}};
    const std::vector<CameraCase> xs{{camera, {0.5f, 0.5f}}, {camera, {1, 0.5f}}, {camera, {0.5f, 0}}, {camera, {0, 1}}};
    const std::vector<vec3> expected{{0, 0, -1}, {0.5f, 0, -1}, {0, 0.25f, -1}, {-0.5f, -0.25f, -1}};
    const auto ys = map<vec3>("camera_direction", xs);
    for (std::size_t i = 0; i < xs.size(); i++) EXPECT_LT(glm::length(ys[i] - glm::normalize(expected[i])), 1e-6) << i;
}

TEST(Kernel, IsFinite) {
    const float nan = std::nanf("");
    std::vector<vec3> xs{{0, 0, 0}, {3e38f, -3e38f, 1e-45f}};
    for (int i = 0; i < 3; i++)
        for (const float bad : {INFINITY, -INFINITY, nan, -nan}) {
            xs.push_back({1, 2, 3});
            xs.back()[i] = bad;
        }
    const auto ys = map<uint>("is_finite", xs);
    for (std::size_t i = 0; i < xs.size(); i++) EXPECT_EQ(ys[i], i < 2) << i;
}

TEST(Kernel, MaxComponent) {
    EXPECT_EQ(map<float>("max_component", std::vector<vec3>{{1, 2, 3}, {3, 1, 2}, {2, 3, 1}, {-3, -1, -2}}), (std::vector<float>{3, 3, 3, -1}));
}

// More elements than one row of 65,535 groups holds.
TEST(Kernel, ThreadsReachEveryElement) {
    std::vector<uint> xs(65'535 * GROUP + 100);
    for (uint i = 0; i < xs.size(); i++) xs[i] = i << 8;
    const auto ys = map<float>("unit_float", xs);
    for (uint i = 0; i < xs.size(); i++) ASSERT_EQ(ys[i], float(i % (1u << 24)) * 0x1p-24f) << i;
}

} // namespace
} // namespace vkpm
