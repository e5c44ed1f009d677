/// Gather radii: the schedule against its recurrence, and the pilot's choice against known densities.
#include "photons_on_device.h"
#include "render/radius.h"
#include "render/radius_field.h"
#include <cmath>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

TEST(Radius, ScheduleFollowsItsRecurrence) {
    for (const float alpha : {0.01f, 0.3f, 2.0f / 3, 0.99f}) {
        long double square = 1;
        for (uint i = 1; i <= 1'000'000; i++) {
            if (i < 100 || i % 99'991 == 0) {
                ASSERT_NEAR(radiusFactor(i - 1, alpha), std::sqrt(double(square)), 2e-7 * std::sqrt(double(square)))
                    << i;
            }
            square *= (i + (long double)alpha) / (i + 1.0L);
        }
    }
    // r(n)^2 / r(1)^2 for alpha = 2/3, Knaus & Zwicker 2011, eq. 16
    EXPECT_NEAR(std::pow(radiusFactor(9, 2.0f / 3), 2), 0.50851584, 1e-6);
    EXPECT_NEAR(std::pow(radiusFactor(99, 2.0f / 3), 2), 0.23838879, 1e-6);
    EXPECT_NEAR(std::pow(radiusFactor(999, 2.0f / 3), 2), 0.11076091, 1e-6);
}

TEST(Radius, ScheduleStaysForAlphaOneAndFallsForever) {
    for (const uint pass : {0u, 1u, 1000u, 0x7fffffffu, 0xfffffffeu}) EXPECT_EQ(radiusFactor(pass, 1), 1.0f);
    float before = 1;
    for (uint pass = 1; pass < 0x7fffffffu; pass += 1 + pass / 2) {
        const float factor = radiusFactor(pass, 2.0f / 3);
        EXPECT_LT(factor, before);
        before = factor;
    }
    EXPECT_NEAR(before / std::pow(2.0, -31.0 / 6), 1 / std::sqrt(std::tgamma(5.0 / 3)),
                0.1); // n^((a-1)/2) / sqrt(Gamma(1 + a))
}

// A floor of side 2 in a scene that a horizon makes a million times as large.
TEST(Radius, ExtentIsThatOfTheLight) {
    Scene scene;
    const float far = 1e6f;
    scene.primitives = {{{-far, 0, -far}, {far, 0, -far}, {far, 0, far}, 0, NONE, NONE}};
    scene.triangleCount = 1;
    scene.bounds = {{-far, 0, -far}, {far, 0, far}};
    const Extent whole = extentOf(scene);
    EXPECT_NEAR(whole.diagonal, std::sqrt(8.0) * double{far}, 1);
    EXPECT_NEAR(whole.area, 2e12, 1e6);

    Random random(6);
    std::vector<vec3> photons;
    for (int i = 0; i < 8000; i++) photons.emplace_back(random.between(-1, 1), 0, random.between(-1, 1));
    for (int i = 0; i < 60; i++) photons.emplace_back(far * random.between(-1, 1), 0, 0); // fewer than a hundredth
    const Extent extent = extentOf(whole, photons);
    EXPECT_NEAR(extent.diagonal, 2 * std::sqrt(8.0), 0.3);
    EXPECT_NEAR(extent.reach, 2, 0.1);
    EXPECT_LT(extent.area, 100);

    // One photon, or all in one place, say nothing about the size of a scene.
    photons.resize(1);
    EXPECT_GT(extentOf(whole, photons).diagonal, 1e6);
    photons.resize(5000, photons[0]);
    EXPECT_GT(extentOf(whole, photons).diagonal, 1e6);

    // What a radius may be at least follows the light, too.
    EXPECT_THROW(requireRadius(whole, 3.0f, "radius"), InputError);
    EXPECT_NO_THROW(requireRadius(whole, 4.0f, "radius"));
    EXPECT_THROW(requireRadius(extent, 1e-6f, "radius"), InputError);
    EXPECT_NO_THROW(requireRadius(extent, 1e-5f, "radius"));
}

// A plane of side 8 with `inverseDensity` photons, and a spot of side 0.2 in its middle with `dense` more.
std::vector<Photon> plane(uint inverseDensity, uint dense, float scale) {
    Random random(5);
    std::vector<Photon> photons;
    const auto add = [&](float half) {
        photons.push_back(
            {vec3(random.between(-half, half), random.between(-half, half), 0.1f) * scale, vec3(1), normalUp});
    };
    for (uint i = 0; i < inverseDensity; i++) add(4);
    for (uint i = 0; i < dense; i++) add(0.1f);
    return photons;
}

// First radii at places, in units of `scale`; the widest is 1.
std::vector<float> measuredRadii(const std::vector<Photon>& photons, float perDisc, const std::vector<vec3>& places,
                                 float scale = 1) {
    PhotonGrid grid(testGpu(), "test");
    Buffer<Photon> buffer(testGpu(), "test photons", photons);
    PhotonMap onDevice = grid.build(buffer, static_cast<uint>(photons.size()), scale, 1, MAX_LEVELS);
    RadiusField field(testGpu());
    field.measure(onDevice, static_cast<uint>(photons.size()), perDisc);
    field.apply(onDevice);
    std::vector<vec3> scaled;
    for (const vec3 place : places) scaled.push_back(place * scale);
    std::vector<float> radii = map<float>("radius_at", scaled, {}, {.photons = onDevice});
    for (float& radius : radii) radius /= scale;
    return radii;
}

TEST(RadiusField, DiscsHoldAsManyPhotonsAsWanted) {
    for (const uint count : {5000u, 20'000u, 80'000u}) {
        const double expected = std::sqrt(20 * 64 / (pi * count)); // of a disc that holds 20
        std::vector<vec3> places;
        for (int i = -3; i <= 3; i++) places.push_back({0.9f * float(i), 0.37f * float(i), 0.1f});
        for (const float radius : measuredRadii(plane(count, 0, 1), 20, places))
            EXPECT_NEAR(radius / expected, 1, 0.3) << count;
    }
}

TEST(RadiusField, SpotsGetSmallRadiiAndWidePlacesWideOnes) {
    const auto radii =
        measuredRadii(plane(2000, 30'000, 1), 10, {{0, 0, 0.1f}, {3, 3, 0.1f}, {-3, 2, 0.1f}, {50, 50, 50}});
    EXPECT_LT(radii[0], 0.1f);  // 10 photons lie within 0.002
    EXPECT_GT(radii[0], 0.06f); // of which a sixteenth is the least there is
    EXPECT_GT(radii[1], 0.2f);  // within 0.32
    EXPECT_GT(radii[2], 0.2f);
    EXPECT_EQ(radii[3], 1.0f); // no photons
}

// Photons of a spot far narrower than a map's narrowest cells want another map, which knows of nothing but the spot.
TEST(RadiusField, NarrowMapsAnswerWhereDiscsAreNarrow) {
    const auto ratio = [](const std::vector<Photon>& photons, float widest, bool partial,
                          const std::vector<vec3>& places, RadiusField& field) {
        PhotonGrid grid(testGpu(), "test", 11);
        const Buffer<Photon> buffer(testGpu(), "test photons", photons);
        PhotonMap map = grid.build(buffer, static_cast<uint>(photons.size()), widest, 1, 3);
        map.partial = partial;
        field.measure(map, static_cast<uint>(photons.size()), 10);
        field.apply(map);
        return ::vkpm::map<float>("radius_at", places, {}, {.photons = map});
    };
    const std::vector<vec3> places{{0, 0, 0.1f}, {0.05f, -0.03f, 0.1f}, {3, 3, 0.1f}, {-3, 2, 0.1f}, {50, 50, 50}};
    const std::vector<Photon> photons = plane(2000, 60'000, 1);
    RadiusField wide(testGpu()), narrow(testGpu());
    ratio(photons, 1, false, places, wide);
    EXPECT_NEAR(wide.overfull, 0.97f, 0.02f);
    const std::vector<float> radii = ratio(photons, 1.0f / 64, true, places, narrow);
    EXPECT_NEAR(narrow.known, 0.97f, 0.02f);
    EXPECT_LT(narrow.overfull, 0.01f);
    const double expected = std::sqrt(10 * 0.04 / (pi * 60'000)); // of a disc that holds 10: 0.0015
    EXPECT_LT(radii[0], 2.5 * expected); // an eighth of the widest is the least there is: 0.002
    EXPECT_NEAR(radii[0], radii[1], 0.3 * radii[0]);
    EXPECT_EQ((std::vector<float>{radii.begin() + 2, radii.end()}), std::vector<float>(3, 0.0f));
}

TEST(RadiusField, ScalesWithTheScene) {
    const std::vector<vec3> places{{0, 0, 0.1f}, {0.3f, -0.2f, 0.1f}, {3, 3, 0.1f}, {-1, 2, 0.1f}};
    const auto tame = measuredRadii(plane(20'000, 3000, 1), 10, places);
    EXPECT_EQ(measuredRadii(plane(20'000, 3000, 1024), 10, places, 1024), tame);
    EXPECT_EQ(measuredRadii(plane(20'000, 3000, 1.0f / 4096), 10, places, 1.0f / 4096), tame);
}

TEST(RadiusField, WithoutPhotonsIsTheWidest) {
    EXPECT_EQ(measuredRadii({Photon{vec3(0), vec3(1), normalUp}}, 10, {{0, 0, 0}}), std::vector<float>{1});
}

} // namespace
} // namespace vkpm
