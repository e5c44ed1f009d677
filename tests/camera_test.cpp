/// Camera directions, and the small functions that every kernel has.
#include "judge.h"
#include "map.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

TEST(Camera, DirectionsThroughTheFilm) {
    const Camera camera{.origin = {5, 5, 5}, .forward = {0, 0, -1}, .right = {0.5f, 0, 0}, .up = {0, 0.25f, 0}};
    const std::vector<CameraCase> xs{
        {camera, {0.5f, 0.5f}}, {camera, {1, 0.5f}}, {camera, {0.5f, 0}}, {camera, {0, 1}}};
    const std::vector<vec3> expected{{0, 0, -1}, {0.5f, 0, -1}, {0, 0.25f, -1}, {-0.5f, -0.25f, -1}};
    const auto ys = map<vec3>("camera_direction", xs);
    for (std::size_t i = 0; i < xs.size(); i++) EXPECT_LT(glm::length(ys[i] - glm::normalize(expected[i])), 1e-6) << i;
}

TEST(Camera, FilmPositionsAreTheInverse) {
    const Camera camera =
        pinholeCamera({.origin = {1, 2, 3}, .target = {2, 1, -1}, .up = {0.2f, 1, 0}, .fieldOfView = 2}, {30, 20});
    std::vector<CameraCase> xs;
    for (const vec2 film : unitSquare(10'000, 1)) xs.push_back({camera, film});
    const auto ys = map<vec2>("film_position", xs);
    for (std::size_t i = 0; i < xs.size(); i++) EXPECT_LT(glm::length(ys[i] - xs[i].film), 1e-6) << i;
}

// What is seen at a place of the film from any point of the lens goes back to that place.
TEST(Camera, FilmPositionsThroughALensAreTheInverse) {
    const View view{.origin = {1, 2, 3}, .target = {2, 1, -1}, .up = {0.2f, 1, 0}, .lens = {0.4f, 1.5f}};
    std::vector<CameraCase> xs;
    for (const vec2 film : unitSquare(10'000, 1)) xs.push_back({pinholeCamera(view, {30, 20}), film});
    const auto ys = map<vec2>("lens_film", xs);
    for (std::size_t i = 0; i < xs.size(); i++) ASSERT_LT(glm::length(ys[i] - xs[i].film), 3e-6) << i;
}

// Together they are the solid angle of the whole film, a rectangle at distance 1 (Howell's catalogue has it as 4 asin).
TEST(Camera, SolidAnglesOfPixelsAddUp) {
    const double x = 2, y = 1;
    const Camera camera{.forward = {0, 0, -1}, .right = {float(x), 0, 0}, .up = {0, float(y), 0}};
    std::vector<CameraCase> xs;
    for (int i = 0; i < 40 * 20; i++)
        xs.push_back({camera, {(float(i % 40) + 0.5f) / 40, (float(i / 40) + 0.5f) / 20}});
    double sum = 0;
    for (const float angle : map<float>("pixel_solid_angle", xs)) sum += double(angle);
    EXPECT_NEAR(sum, 4 * std::asin(x * y / std::sqrt((1 + x * x) * (1 + y * y))), 2e-3);
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
    EXPECT_EQ(map<float>("max_component", std::vector<vec3>{{1, 2, 3}, {3, 1, 2}, {2, 3, 1}, {-3, -1, -2}}),
              (std::vector<float>{3, 3, 3, -1}));
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
