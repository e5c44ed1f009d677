/// The photon grid: every photon in one cell, and every query finds exactly the neighbours of a search through all.
#include "photons_on_device.h"
#include "scene/scene.h"
#include "shared_camera.h"
#include "shared_photons.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

// Photons that can be told apart by colour: (1, index, a number); sums of these integers are exact in float.
std::vector<Photon> photonsAt(const std::vector<vec3>& positions) {
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < positions.size(); i++)
        photons.push_back({positions[i], vec3{1, i, i * 7919 % 251}, normalUp});
    return photons;
}

// Every photon once, under the key of its cell.
void expectEveryPhotonInItsCell(const std::vector<Photon>& photons, const TestMap& onDevice) {
    const uint count = static_cast<uint>(photons.size()), keys = onDevice.map.cellMask + 1;
    std::vector<uint> all(keys + 1), places(count);
    std::iota(all.begin(), all.end(), 0u);
    std::iota(places.begin(), places.end(), 0u);
    const auto starts = map<uint>("cell_start", all, {}, onDevice.context());
    ASSERT_EQ(starts.front(), 0u);
    ASSERT_EQ(starts.back(), count);
    ASSERT_TRUE(std::ranges::is_sorted(starts));

    const auto arranged = map<Photon>("map_photon", places, {}, onDevice.context());
    std::vector<vec3> positions;
    for (const Photon& photon : arranged) positions.push_back(photon.position);
    const auto cells = map<uint>("cell_key", positions, {}, onDevice.context());
    std::vector<int> seen(count);
    for (uint i = 0; i < count; i++) {
        const auto index = static_cast<std::size_t>(arranged[i].color.y);
        ASSERT_LT(index, count);
        ASSERT_EQ(seen[index]++, 0);
        ASSERT_EQ(arranged[i].position, photons[index].position);
        ASSERT_TRUE(starts[cells[i]] <= i && i < starts[cells[i] + 1]);
    }
}

// Counts and sums of colours are those of the photons nearer than the radius; queries with a photon at the radius to a
// rounding are left out. Returns the neighbours found.
double expectNeighbours(const std::vector<Photon>& photons, const std::vector<Query>& queries,
                        const TestMap& onDevice) {
    const double radius = onDevice.map.radius, area = pi * radius * radius;
    const auto found = map<vec3>("estimate_within", queries, {}, onDevice.context());
    double neighbours = 0;
    for (std::size_t i = 0; i < queries.size(); i++) {
        glm::dvec3 sum{0};
        bool clear = true;
        for (const Photon& photon : photons) {
            if (distance2(photon, queries[i], radius) < INFINITY) sum += glm::dvec3(photon.color);
            clear &= (distance2(photon, queries[i], radius * (1 + 1e-6)) == INFINITY) ==
                     (distance2(photon, queries[i], radius * (1 - 1e-6)) == INFINITY);
        }
        if (!clear) continue;
        for (int k = 0; k < 3; k++) EXPECT_NEAR(found[i][k] * area, sum[k], 1e-6 * sum[k] + 1e-6) << "query " << i;
        neighbours += sum.x;
        if (testing::Test::HasFailure()) break;
    }
    return neighbours;
}

// Photons and queries in a box about a point, in units of the radius; thin, so that the tangent plane is near.
double checkCloud(uint count, vec3 center, vec3 half, float radius, uint seed) {
    Random random(seed);
    const auto place = [&] { return (center + random.cube(1) * half) * radius; };
    std::vector<vec3> positions(count);
    for (vec3& position : positions) position = place();
    std::vector<Query> queries;
    for (int i = 0; i < 400; i++) // half of the discs lean
        queries.push_back(
            queryAt(place(), 0, glm::normalize(vec3{0, 0, 1} + (i % 2 ? random.cube(1) * 0.9f : vec3{0}))));
    const auto photons = photonsAt(positions);
    double neighbours = 0;
    for (const uint levels : {0u, 1u, 3u}) {
        const TestMap onDevice(photons, radius, levels);
        expectEveryPhotonInItsCell(photons, onDevice);
        neighbours = expectNeighbours(photons, queries, onDevice);
    }
    return neighbours;
}

TEST(Grid, FindsAllNeighbours) {
    EXPECT_GT(checkCloud(5000, {0, 0, 0}, {20, 20, 0.1f}, 1, 1), 1000);
    EXPECT_GT(checkCloud(5000, {0, 0, 0}, {20, 20, 0.1f}, 0.01f, 2), 1000);
    EXPECT_GT(checkCloud(5000, {0, 0, 0}, {20, 20, 0.1f}, 300, 3), 1000);
    EXPECT_GT(checkCloud(5000, {-500, -300, -700}, {20, 20, 0.1f}, 1, 4), 1000) << "negative coordinates";
    EXPECT_GT(checkCloud(5000, {0, 0, 0}, {3, 3, 3}, 1, 5), 1000) << "a volume";
    EXPECT_GT(checkCloud(5000, {0.5f, 0.5f, 0.5f}, {0.2f, 0.2f, 0.02f}, 1, 6), 1000) << "all in one cell";
    EXPECT_GT(checkCloud(7, {0, 0, 0}, {1, 1, 0.1f}, 1, 7), 100) << "as few keys as can be";
}

// At 1e5 radii a position has a rounding of 0.008 radii: the discs must still be covered.
TEST(Grid, FindsAllNeighboursFarFromTheOrigin) {
    EXPECT_GT(checkCloud(5000, {1e5f, -1e5f, 1e5f}, {20, 20, 0.1f}, 1, 8), 1000);
    EXPECT_GT(checkCloud(5000, {-1e5f, 1e5f, -1e5f}, {20, 20, 0.1f}, 0.01f, 9), 1000);
    EXPECT_GT(checkCloud(5000, {1e6f, -1e6f, 0}, {20, 20, 0.1f}, 1, 10), 1000);
}

// Beyond a thousand million cells all fall together: nothing is lost.
TEST(Grid, BeyondAllCells) {
    const std::vector<Photon> photons = photonsAt({{1e20f, 1e20f, 0}, {-1e30f, 0, 0}, {3e38f, -3e38f, 0}, {0, 0, 0}});
    const TestMap onDevice(photons, 1);
    expectEveryPhotonInItsCell(photons, onDevice);
    std::vector<Query> queries;
    for (const Photon& photon : photons) queries.push_back(queryAt(photon.position));
    for (const vec3 found : map<vec3>("estimate_within", queries, {}, onDevice.context()))
        EXPECT_NEAR(found.x * pi, 1, 1e-6);
}

// Photons and queries exactly at the borders of cells, at their neighbouring floats, and a radius apart.
TEST(Grid, PhotonsAtTheBordersOfCells) {
    const float radius = 1, cell = 2.1f * radius;
    std::vector<vec3> positions;
    std::vector<Query> queries;
    for (int x = -4; x <= 4; x++)
        for (int y = -4; y <= 4; y++)
            for (const float side : {-INFINITY, 0.0f, INFINITY}) {
                const vec3 corner{float(x) * cell / 2, float(y) * cell / 2, 0};
                const vec3 p =
                    side == 0 ? corner : vec3{std::nextafter(corner.x, side), std::nextafter(corner.y, side), 0};
                positions.push_back(p);
                for (const vec3 d :
                     {vec3{0, 0, 0}, vec3{0.999f, 0, 0}, vec3{0, -0.999f, 0}, vec3{-0.7f, 0.7f, 0}, vec3{0, 0, 0.05f}})
                    queries.push_back(queryAt(p + d));
            }
    const auto photons = photonsAt(positions);
    const TestMap onDevice(photons, radius);
    expectEveryPhotonInItsCell(photons, onDevice);
    EXPECT_GE(expectNeighbours(photons, queries, onDevice), 3.0 * double(queries.size()));
}

// Photons whose cells are far apart but share one key, sought among the positions of a wide plane.
TEST(Grid, PhotonsOfOneKey) {
    Random random(11);
    std::vector<vec3> candidates(1'600'000);
    for (vec3& candidate : candidates) candidate = vec3{random.between(-2000, 2000), random.between(-2000, 2000), 0};
    const uint wanted = 1000, mask = 4095; // as the grid chooses for up to 1023 photons
    const PhotonMap shape{.cellsPerUnit = 1 / 2.1f, .cellMask = mask};
    const auto keys = map<uint>("cell_key", candidates, {}, {.photons = shape});
    std::vector<vec3> positions;
    std::vector<Query> queries;
    for (std::size_t i = 0; i < keys.size() && positions.size() < wanted; i++)
        if (keys[i] == keys[0]) positions.push_back(candidates[i]);
    ASSERT_GE(positions.size(), 300u);
    while (positions.size() < wanted) positions.push_back(positions[random.bits() % 300] + random.cube(0.01f));
    for (std::size_t i = 0; i < 300; i++)
        queries.push_back(queryAt(positions[i] + vec3{random.between(-1, 1), random.between(-1, 1), 0}));
    const auto photons = photonsAt(positions);
    const TestMap onDevice(photons, 1, 0);
    ASSERT_EQ(onDevice.map.cellMask, mask);
    expectEveryPhotonInItsCell(photons, onDevice);
    EXPECT_GT(expectNeighbours(photons, queries, onDevice), 200);
}

// ---- Thinning of overfull cells ------------------------------------------------------------------------------------

// Flux of all photons that a map keeps, and how many these are; each of them had a flux of 1.
struct Kept {
    uint most = 0; // in a cell
    double flux = 0;
    double centre = 0; // mean of x, weighted by flux
};

Kept keptIn(const PhotonMap& onDevice) {
    const MapContext context{.photons = onDevice};
    std::vector<uint> all(onDevice.cellMask + 2);
    std::iota(all.begin(), all.end(), 0u);
    const auto starts = map<uint>("cell_start", all, {}, context);
    Kept kept;
    for (std::size_t i = 0; i + 1 < starts.size(); i++) kept.most = std::max(kept.most, starts[i + 1] - starts[i]);
    std::vector<uint> places(starts.back());
    std::iota(places.begin(), places.end(), 0u);
    for (const Photon& photon : map<Photon>("map_photon", places, {}, context)) {
        kept.flux += double{photon.color.x};
        kept.centre += double{photon.color.x} * double{photon.position.x};
    }
    kept.centre /= kept.flux;
    return kept;
}

// No cell has more photons than it may, all flux is there, and it is where it was: the sum of colours exactly, since
// those that stay carry the flux of whole numbers of others; the mean place as exactly as a random choice among runs
// allows.
TEST(Grid, CrowdedCellsAreThinned) {
    Random random(13);
    for (const uint count : {MAX_PHOTONS_PER_CELL + 1, MAX_PHOTONS_PER_CELL * 5 / 4, 2 * MAX_PHOTONS_PER_CELL - 1,
                             5000u, 65'537u, 1'000'000u}) {
        std::vector<Photon> photons(count);
        for (Photon& photon : photons)
            photon = {vec3{random.between(0, 0.5f), random.between(0, 0.5f), 0}, vec3{1}, normalUp};
        Buffer<Photon> buffer(testGpu(), "photons", photons);
        PhotonGrid grid(testGpu(), "test");
        Mean centre;
        for (uint pass = 0; pass < 16; pass++) {
            const Kept kept = keptIn(grid.build(buffer, count, 1, 1, 0, pass));
            ASSERT_EQ(kept.most, MAX_PHOTONS_PER_CELL) << count;
            ASSERT_EQ(kept.flux, count);
            centre.add(kept.centre);
        }
        double truth = 0;
        for (const Photon& photon : photons) truth += double{photon.position.x} / count;
        EXPECT_NEAR(centre.mean(), truth, 5 * 0.5 / std::sqrt(12 * MAX_PHOTONS_PER_CELL * 16)) << count;
        EXPECT_EQ(keptIn(grid.build(buffer, count, 1, 1, 0)).most, count) << "thinned though nobody asked";
    }
}

// Cells that are not overfull keep all of their photons beside one that is.
TEST(Grid, OthersStayAsTheyAre) {
    Random random(14);
    std::vector<vec3> positions;
    for (int i = 0; i < 20'000; i++) positions.push_back({random.between(-30, 30), random.between(-30, 30), 0});
    const std::vector<Query> queries{queryAt({10, 10, 0}), queryAt({-20, 5, 0}), queryAt({3, -17, 0})};
    std::vector<vec3> expected;
    for (const bool overfull : {false, true}) {
        const uint more = overfull ? 50'000 : 0;
        for (uint i = 0; i < more; i++)
            positions.push_back({random.between(-0.1f, 0.1f), random.between(-0.1f, 0.1f), 0});
        const auto photons = photonsAt(positions);
        Buffer<Photon> buffer(testGpu(), "photons", photons);
        PhotonGrid grid(testGpu(), "test");
        const PhotonMap built = grid.build(buffer, static_cast<uint>(photons.size()), 1, 1, 1, 5);
        const auto found = map<vec3>("estimate_within", queries, {}, {.photons = built});
        if (overfull) {
            EXPECT_EQ(found, expected);
        }
        expected = found;
    }
}

// A grid is built anew for each pass: smaller and larger maps after one another.
TEST(Grid, IsBuiltAnew) {
    PhotonGrid grid(testGpu(), "test");
    Random random(12);
    for (const uint count : {1000u, 10u, 5000u, 0u, 1u, 5000u}) {
        std::vector<vec3> positions(count);
        for (vec3& position : positions) position = vec3{random.between(-10, 10), random.between(-10, 10), 0};
        const auto photons = photonsAt(positions);
        Buffer<Photon> buffer(testGpu(), "photons", 6000);
        buffer.upload(photons);
        const PhotonMap built = grid.build(buffer, count, 30, 1);
        const vec3 found = map<vec3>("estimate_within", std::vector{queryAt({0, 0, 0})}, {}, {.photons = built})[0];
        EXPECT_NEAR(found.x * 900 * pi, count, 1e-3 * count) << count;
    }
}

} // namespace
} // namespace vkpm
