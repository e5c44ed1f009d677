/// Frames are orthonormal about any normal, and octahedral codes keep unit vectors.
#include "judge.h"
#include "map.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

std::vector<vec3> unitVectors() {
    std::vector<vec3> vectors;
    for (int axis = 0; axis < 3; axis++)
        for (const float sign : {1.0f, -1.0f}) {
            vec3 v{0, 0, 0};
            v[axis] = sign;
            vectors.push_back(v);
        }
    const float below = std::nextafter(1.0f, 0.0f), side = std::sqrt(1 - below * below);
    for (const float z : {below, -below})
        for (const vec3 v : {vec3{0, 0, z}, vec3{side, 0, z}, vec3{0, -side, z}, vec3{1, 0, 0 * z}})
            vectors.push_back(v);
    Random random(1);
    for (int i = 0; i < 100'000; i++) vectors.push_back(random.direction());
    return vectors;
}

TEST(Frame, ToWorldIsOrthonormal) {
    const auto normals = unitVectors();
    std::vector<VectorPair> xs;
    for (const vec3 n : normals)
        for (const vec3 v : {vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}}) xs.push_back({v, n});
    const auto ys = map<vec3>("to_world", xs);
    for (std::size_t i = 0; i < normals.size(); i++) {
        const vec3 x = ys[3 * i], y = ys[3 * i + 1], z = ys[3 * i + 2];
        ASSERT_EQ(z, normals[i]);
        // A few roundings of 6e-8 each.
        ASSERT_LT(glm::length(glm::cross(x, y) - z), 1e-6) << z.x << " " << z.y << " " << z.z;
        ASSERT_NEAR(glm::dot(x, y), 0, 1e-6);
        ASSERT_NEAR(glm::length(x), 1, 1e-6);
        ASSERT_NEAR(glm::length(y), 1, 1e-6);
    }
}

TEST(Frame, ToWorldIsLinear) {
    const vec3 n = glm::normalize(vec3{1, -2, -3});
    const auto ys =
        map<vec3>("to_world", std::vector<VectorPair>{{{1, 0, 0}, n}, {{0, 1, 0}, n}, {{0, 0, 1}, n}, {{2, -3, 5}, n}});
    EXPECT_LT(glm::length(ys[3] - (2.0f * ys[0] - 3.0f * ys[1] + 5.0f * ys[2])), 1e-5);
}

// The spacing of the code is 2 / 32767 in a coordinate; its half, stretched by at most 1.8 in angle, is 5.5e-5.
TEST(Frame, OctahedralCodesKeepUnitVectors) {
    const auto vectors = unitVectors();
    const auto found = map<vec3>("unpack_unit", map<uint>("pack_unit", vectors));
    for (std::size_t i = 0; i < vectors.size(); i++) {
        ASSERT_LT(glm::length(found[i] - vectors[i]), i < 6 ? 1e-7 : 1e-4) << i;
        ASSERT_NEAR(glm::length(found[i]), 1, 1e-6);
    }
}

// But for vectors with z about 0 and codes at the border of the square, where two codes may mean the same.
TEST(Frame, OctahedralCodesSurviveARoundTrip) {
    Random random(2);
    std::vector<uint> codes;
    for (int i = 0; i < 100'000; i++) codes.push_back((1 + random.bits() % 65533) | (1 + random.bits() % 65533) << 16);
    const auto vectors = map<vec3>("unpack_unit", codes);
    const auto again = map<uint>("pack_unit", vectors);
    for (std::size_t i = 0; i < codes.size(); i++)
        ASSERT_TRUE(again[i] == codes[i] || std::abs(vectors[i].z) < 1e-4f) << std::hex << codes[i] << " " << again[i];
}

} // namespace
} // namespace vkpm
