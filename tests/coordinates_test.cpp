/// The origin and the unit of a scene's coordinates: 0 and 1 where they cost nothing, near the shapes elsewhere, and
/// exact.
#include "judge.h"
#include "render_support.h"
#include "scene/coordinates.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

std::vector<dvec3> somePlaces(int count, uint seed) {
    Random random(seed);
    std::vector<dvec3> places;
    for (int i = 0; i < count; i++) places.push_back(dvec3(random.cube(2)));
    return places;
}

std::vector<dvec3> changed(std::vector<dvec3> places, double factor, dvec3 by) {
    for (dvec3& place : places) place = factor * place + by;
    return places;
}

dvec3 originFor(const std::vector<dvec3>& places) { return chooseCoordinates(places).origin; }

TEST(Origin, IsZeroForScenesThatStandThere) {
    EXPECT_EQ(originFor({}), dvec3(0));
    EXPECT_EQ(originFor({{5, 6, 7}}), dvec3(0)) << "one place has no size";
    for (uint seed = 1; seed < 20; seed++) EXPECT_EQ(originFor(somePlaces(30, seed)), dvec3(0));
    for (const char* name : {"box", "diffuse_box", "ring", "glass", "pool"})
        EXPECT_EQ(shippedScene(name).coordinates, Coordinates{}) << name;
}

TEST(Origin, FollowsTheShapesFarAway) {
    for (const double far : {1e4, -3.7e5, 1e6, 1e9}) {
        const dvec3 by{far, -far / 3, 0};
        const dvec3 origin = originFor(changed(somePlaces(30, 2), 1, by));
        EXPECT_LT(glm::length(origin - by), 64) << far;
        EXPECT_EQ(origin, glm::floor(origin)) << "a multiple of a power of two, here above 1";
    }
}

// Scaling by a power of two scales the origin; moving by a multiple of the step moves it.
TEST(Origin, IsExact) {
    const auto places = changed(somePlaces(30, 3), 1, {1e6, 0, -2e6});
    const dvec3 origin = originFor(places);
    EXPECT_EQ(originFor(changed(places, 0x1p-20, dvec3(0))), origin * 0x1p-20);
    EXPECT_EQ(originFor(changed(places, 0x1p30, dvec3(0))), origin * 0x1p30);
    EXPECT_EQ(originFor(changed(places, 1, dvec3(1 << 20))), origin + dvec3(1 << 20));
}

TEST(Origin, OneShapeOfTheSizeOfAPlanetDoesNotDrawIt) {
    auto places = somePlaces(9, 4);
    places.push_back({0, -1e7, 0});
    places.push_back({0, -2e7, 0});
    EXPECT_EQ(originFor(places), dvec3(0));
}

TEST(Unit, IsOneForScenesOfUsualSize) {
    EXPECT_EQ(chooseCoordinates({}).unit, 1);
    EXPECT_EQ(chooseCoordinates({{5, 6, 7}}).unit, 1);
    for (const double size : {1e-4, 1.0, 1e4})
        EXPECT_EQ(chooseCoordinates(changed(somePlaces(30, 5), size, {size, 0, 0})).unit, 1) << size;
}

TEST(Unit, IsAPowerOfTwoNearTheSizeOfOthers) {
    for (const double size : {1e-9, 1e-6, 1e6, 1e9, 1e12}) {
        const Coordinates chosen = chooseCoordinates(changed(somePlaces(30, 5), size, {size, 0, 0}));
        EXPECT_EQ(std::exp2(std::round(std::log2(chosen.unit))), chosen.unit);
        EXPECT_GT(chosen.unit, 0.1 * size);
        EXPECT_LT(chosen.unit, 4 * size);
        EXPECT_EQ(chosen.world(vec3(chosen.inside(chosen.origin + dvec3(chosen.unit)))),
                  chosen.origin + dvec3(chosen.unit));
    }
}

TEST(Unit, LeavesRoomForTheFarthest) {
    auto places = changed(somePlaces(30, 5), 1e-9, dvec3(0));
    places.push_back({1e12, 0, 0});
    EXPECT_LE(1e12 / chooseCoordinates(places).unit, 0x1p41);
}

} // namespace
} // namespace vkpm
