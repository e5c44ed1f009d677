/// Density estimates: normalised kernels, no bias over uniform photons, and only photons that should count.
#include "photons_on_device.h"
#include "scene_on_device.h"
#include "shared_camera.h"
#include "shared_photons.h"
#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

const std::vector<uint> kernels{DENSITY_KERNEL_CONSTANT, DENSITY_KERNEL_CONE, DENSITY_KERNEL_GAUSS,
                                DENSITY_KERNEL_EPANECHNIKOV};
const std::vector<double> varianceFactors{1, 1.295858, 1.129309, 4.0 / 3}; // over the disc, of the weights

// Over the disc, squared distance is uniform.
TEST(Density, KernelsAreNormalised) {
    const int count = 1 << 16;
    for (const uint kernel : kernels) {
        std::vector<vec2> xs;
        for (int i = 0; i < count; i++) xs.push_back({kernel, (i + 0.5) / count});
        Mean weight, square;
        for (const float w : map<float>("density_weight", xs)) {
            ASSERT_GE(w, 0);
            weight.add(w);
            square.add(double{w} * w);
        }
        EXPECT_NEAR(weight.mean(), 1, 1e-5) << kernel;
        EXPECT_NEAR(square.mean(), varianceFactors[kernel], 1e-4) << kernel;
    }
}

const vec3 color{1, 0.5f, 0.25f};

// Photons uniform over the part of [-1, 1]^2 that `keep` keeps, facing up.
std::vector<Photon> uniformPhotons(
    uint count, uint seed, const std::function<bool(vec2)>& keep = [](vec2) { return true; }) {
    Random random(seed);
    std::vector<Photon> photons;
    for (uint i = 0; i < count; i++) {
        const vec2 p{random.between(-1, 1), random.between(-1, 1)};
        if (keep(p)) photons.push_back({vec3{p, 0}, color, normalUp});
    }
    return photons;
}

std::vector<Query> uniformQueries(uint count, uint seed, uint nearest = 0) {
    Random random(seed);
    std::vector<Query> queries;
    for (uint i = 0; i < count; i++)
        queries.push_back(queryAt({random.between(-0.9f, 0.9f), random.between(-0.9f, 0.9f), 0}, nearest));
    return queries;
}

const uint photonCount = 1u << 18;
const double density = photonCount / 4.0; // per unit of area
const float radius = 0.02f;               // 82 photons within it

// Independent queries deviate by sqrt(v / M), M photons expected; the mean over the plane by sqrt(1 / photons on it).
TEST(Density, UniformPhotonsAreEstimatedWithoutBias) {
    const TestMap photons(uniformPhotons(photonCount, 1), radius);
    const double expected = density * pi * radius * radius;
    for (const uint kernel : kernels) {
        Mean mean;
        for (const vec3 e :
             map<vec3>("estimate_within", uniformQueries(8192, 2), {.densityKernel = kernel}, photons.context())) {
            mean.add(e.x / density);
            ASSERT_NEAR(e.y, e.x / 2, 1e-5 * e.x);
            ASSERT_NEAR(e.z, e.x / 4, 1e-5 * e.x);
        }
        EXPECT_NEAR(mean.mean(), 1, 5 * std::hypot(mean.error(), std::sqrt(1 / (0.81 * photonCount)))) << kernel;
        EXPECT_NEAR(mean.deviation(), std::sqrt(varianceFactors[kernel] / expected), 0.1 * mean.deviation()) << kernel;
    }
}

TEST(Density, PhotonsFromBehindAndOffThePlaneDoNotCount) {
    auto photons = uniformPhotons(20'000, 3);
    const auto queries = uniformQueries(1000, 4, 20);
    const float r = 0.1f;
    const TestMap alone(photons, r);
    const auto expected = map<vec3>("estimate_within", queries, {}, alone.context());
    const auto expectedRadii = map<float>("nearest_radius", queries, {.hasNearest = 1}, alone.context());
    for (std::size_t i = 0; i < 20'000; i++) {
        Photon behind = photons[i], above = photons[i], sideways = photons[i];
        behind.position += vec3{0.01f, 0, 0};
        behind.normal = normalDown;
        above.position.z = i % 2 ? 0.11f * r : -0.11f * r;
        sideways.normal = 65534u | 32767u << 16; // +x
        photons.insert(photons.end(), {behind, above, sideways});
    }
    const TestMap more(photons, r);
    const auto found = map<vec3>("estimate_within", queries, {}, more.context());
    const auto radii = map<float>("nearest_radius", queries, {.hasNearest = 1}, more.context());
    for (std::size_t i = 0; i < queries.size(); i++) {
        ASSERT_NEAR(found[i].x, expected[i].x, 1e-5 * expected[i].x);
        ASSERT_EQ(radii[i], expectedRadii[i]) << "a photon that does not count took a place among the nearest";
    }
}

// A curved surface leaves the tangent plane; photons within a tenth of the radius of it do count.
TEST(Density, PhotonsNearThePlaneCount) {
    auto photons = uniformPhotons(20'000, 3);
    const auto queries = uniformQueries(1000, 4);
    const auto expected = map<vec3>("estimate_within", queries, {}, TestMap(photons, 0.1f).context());
    for (Photon& photon : photons) photon.position.z = 0.0001f;
    const auto found = map<vec3>("estimate_within", queries, {}, TestMap(photons, 0.1f).context());
    for (std::size_t i = 0; i < queries.size(); i++) ASSERT_NEAR(found[i].x, expected[i].x, 0.03 * expected[i].x);
}

double bruteForceNearest(const std::vector<Photon>& photons, const Query& query, double within) {
    std::vector<double> distances;
    for (const Photon& photon : photons) {
        const double d2 = distance2(photon, query, within);
        if (d2 < INFINITY) distances.push_back(d2);
    }
    if (distances.size() < query.column) return within;
    std::ranges::nth_element(distances, distances.begin() + query.column - 1);
    return std::sqrt(distances[query.column - 1]);
}

TEST(Density, NearestRadiusIsTheDistanceOfTheKthPhoton) {
    for (const uint nearest : {1u, 2u, 10u, 100u, 5000u}) {
        const auto photons = uniformPhotons(20'000, 5);
        const auto queries = uniformQueries(300, 6, nearest);
        const TestMap onDevice(photons, 0.2f); // 628 photons
        const auto radii = map<float>("nearest_radius", queries, {.hasNearest = 1}, onDevice.context());
        for (std::size_t i = 0; i < queries.size(); i++) {
            // Squared distances are told apart to 2^-20 of the search radius's.
            const double expected = bruteForceNearest(photons, queries[i], 0.2f);
            ASSERT_NEAR(radii[i] * radii[i], expected * expected, 0.04 * 0x1p-20 + 4e-6 * expected * expected)
                << nearest;
        }
    }
}

// Photons at equal distances cannot be told apart: the radius is theirs to 2^-20.
TEST(Density, NearestRadiusOfPhotonsEquallyFar) {
    std::vector<Photon> photons;
    for (int i = 0; i < 64; i++) photons.push_back({vec3{0.5, 0, 0}, color, normalUp});
    const TestMap onDevice(photons, 1);
    for (const float r : map<float>("nearest_radius", std::vector{queryAt({0, 0, 0}, 1), queryAt({0, 0, 0}, 64)}, {},
                                    onDevice.context()))
        EXPECT_NEAR(r, 0.5, 2e-6);
    EXPECT_EQ(map<float>("nearest_radius", std::vector{queryAt({0, 0, 0}, 65)}, {}, onDevice.context())[0], 1);
}

// With the constant kernel k - 1 photons lie within the k-th distance: with k the mean would be k / (k - 1), 11 % at k
// = 10.
TEST(Density, NearestEstimatesAreUnbiased) {
    const TestMap photons(uniformPhotons(photonCount, 7), radius);
    for (const uint nearest : {5u, 10u, 30u}) {
        Mean mean;
        for (const vec3 e :
             map<vec3>("estimate_nearest", uniformQueries(8192, 8, nearest), {.hasNearest = 1}, photons.context()))
            mean.add(e.x / density);
        EXPECT_NEAR(mean.mean(), 1, 5 * std::hypot(mean.error(), std::sqrt(1 / (0.81 * photonCount)))) << nearest;
        EXPECT_NEAR(mean.deviation(), 1 / std::sqrt(nearest - 2.0), 0.1 / std::sqrt(nearest - 2.0)) << nearest;
    }
}

// The mean over `count` queries at a place of the edge, over the density; each sees photons of its own.
Mean alongEdge(const TestMap& photons, const std::function<vec3(float)>& place, uint kernel) {
    std::vector<Query> queries;
    for (int i = 0; i < 40; i++) queries.push_back(queryAt(place(-0.9f + 0.045f * float(i))));
    Mean mean;
    for (const vec3 e : map<vec3>("estimate_within", queries, {.densityKernel = kernel}, photons.context()))
        mean.add(e.x / density);
    return mean;
}

TEST(Density, EdgesSeeAHalfAndCornersAQuarter) {
    const TestMap half(uniformPhotons(photonCount, 9, [](vec2 p) { return p.x > 0; }), radius);
    // A corner at the middle of each of 45 x 45 squares along the diagonal.
    const TestMap corners(uniformPhotons(
                              photonCount, 10,
                              [](vec2 p) {
        const vec2 q = (p + 0.9225f) / 0.045f;
        return q.x - std::floor(q.x) > 0.5f && q.y - std::floor(q.y) > 0.5f;
                              }),
                          radius);
    for (const uint kernel : kernels) {
        const Mean edge = alongEdge(
            half,
            [](float s) {
            return vec3{0, s, 0};
            },
            kernel);
        EXPECT_NEAR(edge.mean(), 0.5, 5 * edge.error()) << kernel;
        EXPECT_LT(edge.error(), 0.03);
        const Mean corner = alongEdge(
            corners,
            [](float s) {
            return vec3{s, s, 0};
            },
            kernel);
        EXPECT_NEAR(corner.mean(), 0.25, 5 * corner.error()) << kernel;
        EXPECT_LT(corner.error(), 0.03);
    }
}

TEST(Density, OneAndNoPhotons) {
    const double area = pi * 0.25;
    const std::vector<Query> queries{queryAt({1, 2, 3}), queryAt({1.4f, 2, 3}), queryAt({1.6f, 2, 3}),
                                     queryAt({-100, 1e6f, 3})};
    const TestMap one({{{1, 2, 3}, color, normalUp}}, 0.5f);
    const auto ys = map<vec3>("estimate_within", queries, {}, one.context());
    for (const int i : {0, 1}) EXPECT_LT(glm::length(ys[i] - color / float(area)), 1e-6);
    for (const int i : {2, 3}) EXPECT_EQ(ys[i], vec3(0));
    const TestMap none({}, 0.5f);
    for (const vec3 y : map<vec3>("estimate_within", queries, {}, none.context())) EXPECT_EQ(y, vec3(0));
    for (const float r : map<float>("nearest_radius", std::vector{queryAt({1, 2, 3}, 5)}, {}, none.context()))
        EXPECT_EQ(r, 0.5f);
}

/// Of a disc of radius one, the part that lies beyond a straight line at distance t from the middle.
double beyond(double t) { return t < 1 ? (std::acos(t) - t * std::sqrt(1 - t * t)) / pi : 0; }

/// One over the covered parts of discs at points of a line from (x, -0.5, 0) to (x, 0.5, 0).
std::vector<vec2> coverageAlong(const Scene& scene, float x, float discRadius) {
    Random random(11);
    std::vector<Query> queries;
    for (uint i = 0; i < 20'000; i++) queries.push_back(queryAt({x, random.between(-0.5f, 0.5f), 0}));
    const TestScene onDevice(scene);
    return map<vec2>("inverse_coverage", queries, {}, {.scene = onDevice.address, .photons = {.radius = discRadius}});
}

/// A square of two triangles and, at x = 1, what closes it.
Scene squareWith(std::vector<Primitive> more, float scale = 1) {
    const vec3 a{-1, -1, 0}, b{1, -1, 0}, c{1, 1, 0}, d{-1, 1, 0};
    more.insert(more.begin(), {triangle(a, b, c), triangle(a, c, d)});
    for (Primitive& p : more) p.a *= scale, p.b *= scale, p.c *= scale;
    const uint count = uint(more.size());
    return sceneOf(std::move(more), count);
}

// At a free edge, also of what lets a part of the light through, whose photons make up for that; in a corner, and in a
// corner with a sheet of glass before it.
TEST(Density, CoverageIsThePartOfADiscThatLiesOnSurfaces) {
    const vec3 low{1, -1, 0}, high{1, 1, 0}, up{0, 0, 1};
    const Scene edge = squareWith({});
    const Scene corner = squareWith({triangle(low, high, high + up), triangle(low, high + up, low + up)});
    Scene pane = squareWith({triangle({0.5f, -1, 0.005f}, {1, -1, 0.005f}, {1, 1, 0.005f}),
                             triangle({0.5f, -1, 0.005f}, {1, 1, 0.005f}, {0.5f, 1, 0.005f})});
    pane.materials.push_back({MATERIAL_GLASS, vec3{1}, 1.5f});
    for (Primitive& p : pane.primitives)
        if (p.a.z > 0) p.material = 1;
    Scene sheet = squareWith({});
    for (Material& m : sheet.materials) m.seeThrough = 0.6f;
    const float r = 0.2f;
    for (const Scene* scene : std::initializer_list<const Scene*>{&edge, &sheet, &corner, &pane})
        for (const double t : {0.1, 0.4, 0.8}) {
            Mean outer, inner;
            for (const vec2 v : coverageAlong(*scene, float(1 - t * double{r}), r)) outer.add(v.x), inner.add(v.y);
            EXPECT_NEAR(outer.mean(), 1 / (1 - beyond(t)), 5 * outer.error()) << t;
            EXPECT_NEAR(inner.mean(), 1 / (1 - beyond(t * std::sqrt(2))), 5 * inner.error() + 1e-6) << t;
        }
    for (const vec2 v : coverageAlong(corner, 0.75f, r)) ASSERT_EQ(v, vec2(1)); // the diagonal is no edge
}

TEST(Density, CoverageDoesNotDependOnTheScale) {
    const Scene small = squareWith({}), large = squareWith({}, 1024);
    const TestScene smallScene(small), largeScene(large);
    std::vector<Query> queries = uniformQueries(1000, 12);
    for (Query& query : queries) query.position.x = 0.95f;
    const auto found =
        map<vec2>("inverse_coverage", queries, {}, {.scene = smallScene.address, .photons = {.radius = 0.1f}});
    for (Query& query : queries) query.position *= 1024;
    EXPECT_EQ(found, (map<vec2>("inverse_coverage", queries, {},
                                {.scene = largeScene.address, .photons = {.radius = 102.4f}})));
    EXPECT_GT(std::ranges::count_if(found, [](vec2 v) { return v.x > 1; }), 50);
}

// What bulges out of the tangent plane keeps no photons that count there: of a ball the cap that is a tenth of the
// radius high.
TEST(Density, CoverageOfABallIsItsCap) {
    const float r = 0.2f, ball = 0.25f;
    const TestScene scene(sceneOf({sphere({0, 0, -ball}, ball)}, 0));
    std::vector<Query> queries;
    Random random(13);
    for (uint i = 0; i < 20'000; i++) // near the top
        queries.push_back(queryAt({random.between(-8e-3f, 8e-3f), random.between(-8e-3f, 8e-3f), 0}));
    const double sag = 0.1 * double{r}, part = sag * (2 * double{ball} - sag) / double{r * r};
    Mean mean;
    for (const vec2 v : map<vec2>("inverse_coverage", queries, {}, {.scene = scene.address, .photons = {.radius = r}}))
        mean.add(v.x);
    EXPECT_NEAR(mean.mean(), 1 / part, 5 * mean.error() + 0.01);
}

} // namespace
} // namespace vkpm
