/// Lights: chosen by their probabilities, sampled uniformly over area, seen from the sides that emit.
#include "judge.h"
#include "scene_on_device.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

const vec3 white{1, 1, 1};

Light rectangle(vec3 a, vec3 u, vec3 v) {
    return {.a = a, .u = u, .v = v, .radiance = white, .kind = LIGHT_RECTANGLE, .area = glm::length(glm::cross(u, v))};
}

TestScene sceneWith(std::vector<Light> lights, std::vector<float> cdf = {1}) {
    Scene scene = sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1);
    scene.lights = std::move(lights);
    scene.lightCdf = std::move(cdf);
    return TestScene(scene);
}

std::vector<LightValues> sampleEmissionPoint(const Light& light, const std::vector<vec2>& us) {
    const TestScene scene = sceneWith({light});
    return map<LightValues>("emission_point", us, {}, scene.context());
}

// How often each light is chosen by the numbers (i + 0.5) / count: exactly its probability, to one at each end of its
// part.
void expectFrequencies(const std::vector<float>& cdf, uint hasManyLights) {
    const uint count = 1u << 20;
    std::vector<float> us;
    for (uint i = 0; i < count; i++) us.push_back((float(i) + 0.5f) / float(count));
    for (const float end : cdf)
        for (const float u : {end, std::nextafter(end, 0.0f)})
            if (u < 1) us.push_back(u);
    const TestScene scene = sceneWith(std::vector<Light>(cdf.size(), rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), cdf);
    const auto chosen = map<uint>("choose_light", us, {.hasManyLights = hasManyLights != 0}, scene.context());
    std::vector<double> counts(cdf.size());
    for (std::size_t i = 0; i < us.size(); i++) {
        ASSERT_LT(chosen[i], cdf.size());
        const float low = chosen[i] == 0 ? 0 : cdf[chosen[i] - 1];
        ASSERT_TRUE(low <= us[i] && us[i] < cdf[chosen[i]]) << us[i] << " chose " << chosen[i];
        if (i < count) counts[chosen[i]]++;
    }
    for (std::size_t i = 0; i < cdf.size(); i++)
        ASSERT_NEAR(counts[i], (double{cdf[i]} - (i == 0 ? 0 : double{cdf[i - 1]})) * count, 1.001) << i;
}

TEST(Light, IsChosenByItsProbability) {
    expectFrequencies({1}, 0);
    expectFrequencies({1}, 1);
    expectFrequencies({0.3f, 1}, 1);
    // The first, the last and others between have no probability.
    expectFrequencies({0, 0.25f, 0.25f, 0.25f, 0.5f, 1, 1}, 1);
    Random random(1);
    std::vector<double> weights;
    for (int i = 0; i < 1000; i++) weights.push_back(i % 7 == 0 ? 0 : std::exp2(random.between(-8, 0)));
    double total = 0, sum = 0;
    for (const double w : weights) total += w;
    std::vector<float> cdf;
    for (const double w : weights) cdf.push_back(static_cast<float>((sum += w) / total));
    cdf.back() = 1;
    expectFrequencies(cdf, 1);
}

TEST(Light, RectanglesAreSampledUniformly) {
    const Light light = rectangle({1, 2, 3}, {2, 0, 1}, {-1, 3, 2});
    Histogram histogram(16, 16);
    const dvec3 u = light.u, v = light.v, n = glm::normalize(glm::cross(u, v));
    for (const LightValues& y : sampleEmissionPoint(light, unitSquare(1 << 18, 1))) {
        const dvec3 d = dvec3(y.position) - dvec3(light.a), uv = glm::cross(u, v);
        histogram.add(glm::dot(glm::cross(d, v), uv) / glm::dot(uv, uv),
                      glm::dot(glm::cross(u, d), uv) / glm::dot(uv, uv));
        ASSERT_NEAR(glm::dot(d, n), 0, 1e-6);
        ASSERT_LT(glm::length(dvec3(y.normal) - n), 1e-6);
        for (int i = 0; i < 3; i++) ASSERT_GE(y.magnitude[i], std::abs(y.position[i]));
    }
    EXPECT_LT(histogram.deviation(), 5);
}

// The square of one weight's complement, and the ratio of the others, are uniform.
TEST(Light, TrianglesAreSampledUniformly) {
    Light light = rectangle({1, 2, 3}, {2, 0, 1}, {-1, 3, 2});
    light.kind = LIGHT_TRIANGLE;
    light.area /= 2;
    Histogram histogram(16, 16);
    const dvec3 u = light.u, v = light.v, uv = glm::cross(u, v);
    for (const LightValues& y : sampleEmissionPoint(light, unitSquare(1 << 18, 2))) {
        const dvec3 d = dvec3(y.position) - dvec3(light.a);
        const double x = glm::dot(glm::cross(d, v), uv) / glm::dot(uv, uv),
                     z = glm::dot(glm::cross(u, d), uv) / glm::dot(uv, uv);
        // x uniform in area: P(x < t) = 1 - (1 - t)^2; given x, z is uniform up to 1 - x.
        histogram.add(1 - (1 - x) * (1 - x), x < 1 - 1e-3 ? z / (1 - x) : 0.5);
        ASSERT_LT(glm::length(dvec3(y.normal) - glm::normalize(uv)), 1e-6);
        for (int i = 0; i < 3; i++) ASSERT_GE(y.magnitude[i], std::abs(y.position[i]));
    }
    EXPECT_LT(histogram.deviation(), 5);
}

TEST(Light, SpheresAreSampledUniformly) {
    const Light light{
        .a = {1, -2, 3}, .u = {0.5f, 0, 0}, .v = {}, .radiance = white, .kind = LIGHT_SPHERE, .area = float(pi)};
    Histogram histogram(16, 16);
    for (const LightValues& y : sampleEmissionPoint(light, unitSquare(1 << 18, 3))) {
        const dvec3 n = (dvec3(y.position) - dvec3(light.a)) * 2.0;
        histogram.add((n.z + 1) / 2, turn(n.x, n.y));
        ASSERT_NEAR(glm::length(n), 1, 2e-6);
        ASSERT_LT(glm::length(n - dvec3(y.normal)), 2e-6);
        for (int i = 0; i < 3; i++) ASSERT_GE(y.magnitude[i], std::abs(y.position[i]));
    }
    EXPECT_LT(histogram.deviation(), 5);
}

Light sphereLight(vec3 center, float radius) {
    const float area = float(4 * pi) * radius * radius;
    return {.a = center, .u = {radius, 0, 0}, .v = {}, .radiance = white, .kind = LIGHT_SPHERE, .area = area};
}

std::vector<LightSampleValues> lightSamples(const Light& light, vec3 origin, uint count) {
    std::vector<VectorPair> xs;
    for (const vec2 u : unitSquare(count, 7)) xs.push_back({origin, vec3{u, 0}});
    return map<LightSampleValues>("light_sample", xs, {}, sceneWith({light}).context());
}

// From outside: on the sphere, on the near side, uniform over the solid angle of the cone, near and far.
TEST(Light, SpheresAreSeenUniformlyByAngle) {
    const vec3 center{1, -2, 3};
    for (const float distance : {0.51f, 1.0f, 30.0f}) {
        const dvec3 axis = glm::normalize(dvec3{1, 2, -0.5});
        const vec3 origin = vec3(dvec3(center) - double{distance} * axis);
        const double radius = 0.5, away = glm::length(dvec3(center) - dvec3(origin)),
                     sine2 = radius * radius / (away * away);
        const double height = sine2 / (1 + std::sqrt(1 - sine2));
        const dvec3 side = glm::normalize(glm::cross(axis, dvec3{0, 0, 1})), up = glm::cross(side, axis);
        Histogram histogram(16, 16);
        for (const LightSampleValues& y : lightSamples(sphereLight(center, 0.5f), origin, 1 << 18)) {
            const dvec3 n = (dvec3(y.position) - dvec3(center)) / radius,
                        w = glm::normalize(dvec3(y.position) - dvec3(origin));
            ASSERT_NEAR(glm::length(n), 1, 1e-5);
            ASSERT_LT(glm::length(n - dvec3(y.normal)), 1e-5);
            ASSERT_LT(glm::dot(w, n), 2e-3);
            ASSERT_NEAR(y.inversePdf, 2 * pi * height, 1e-5 * height);
            const double x = glm::length(glm::cross(w, axis)), cosine = glm::dot(w, axis);
            histogram.add(x * x / (1 + cosine) / height, turn(glm::dot(w, side), glm::dot(w, up)));
        }
        EXPECT_LT(histogram.deviation(), 5) << distance;
    }
}

// A flat light about the z axis, at height z over the origin.
struct FlatLight {
    double x, y, z, width, height;
    uint kind = LIGHT_RECTANGLE;

    Light light() const {
        Light l = rectangle({float(x), float(y), float(z)}, {0, float(height), 0}, {float(width), 0, 0});
        l.kind = kind;
        if (kind == LIGHT_TRIANGLE) l.area /= 2;
        return l;
    }

    // The solid angle of the rectangle between the corner and (x + s width, y + t height), as seen from the origin,
    // less what does not depend on both.
    double toCorner(double s, double t) const {
        const double cx = x + s * width, cy = y + t * height;
        return std::atan2(cx * cy, z * std::sqrt(cx * cx + cy * cy + z * z));
    }

    // What one rounding of the origin changes in the direction to the nearest side.
    double rounding() const {
        return 0x1p-23 / std::hypot(z, std::min({std::abs(x), std::abs(y), std::abs(x + width), std::abs(y + height)}));
    }

    double cell(int i, int j, int side) const {
        const double s = double(i) / side, t = double(j) / side, step = 1.0 / side;
        return toCorner(s + step, t + step) - toCorner(s, t + step) - toCorner(s + step, t) + toCorner(s, t);
    }

    // Of a triangle by Van Oosterom & Strackee (1983, eq. 8).
    double solidAngle() const {
        if (kind == LIGHT_RECTANGLE) return cell(0, 0, 1);
        const dvec3 a{x, y, z}, b{x + width, y, z}, c{x, y + height, z};
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
        return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), below);
    }
};

// Seen from before the middle, from close to it, to an edge, to a corner and to the plane beside it, from a large side,
// and from as far as points are chosen by angle: each cell of the light gets as many points as its solid angle says.
TEST(Light, FlatLightsAreSeenUniformlyByAngle) {
    const int side = 8;
    const uint count = 1 << 18;
    for (const uint kind : {LIGHT_RECTANGLE, LIGHT_TRIANGLE})
        for (FlatLight flat : {FlatLight{-0.5, -0.5, 1, 1, 1},
                               {-0.3, -0.4, 0.01, 1, 1},
                               {-0.3, -0.4, 1e-5, 1, 1},
                               {-0.5, 0.001, 0.01, 1, 1},
                               {0.001, 0.002, 0.005, 1, 1},
                               {0.5, -0.5, 0.02, 1, 2},
                               {-0.01, -10, 0.1, 0.02, 20},
                               {-0.5, 0.5, 2, 1, 1}}) {
            flat.kind = kind;
            const Light light = flat.light();
            const double whole = flat.solidAngle();
            std::vector<double> found(side * side);
            for (const LightSampleValues& y : lightSamples(light, vec3{0}, count)) {
                ASSERT_NEAR(y.inversePdf, whole, 1e-6 * whole + 4 * flat.rounding()) << kind << " z " << flat.z;
                const double s = (double{y.position.x} - flat.x) / flat.width,
                             t = (double{y.position.y} - flat.y) / flat.height;
                ASSERT_TRUE(s >= -1e-6 && t >= -1e-6 && (kind == LIGHT_TRIANGLE ? s + t : std::max(s, t)) <= 1 + 1e-6)
                    << s << " " << t;
                found[std::min(int(std::max(s, 0.0) * side), side - 1) +
                      side * std::min(int(std::max(t, 0.0) * side), side - 1)]++;
            }
            for (int i = 0; i < side; i++)
                for (int j = 0; j < (kind == LIGHT_TRIANGLE ? side - 1 - i : side); j++) {
                    const double expected = count * flat.cell(i, j, side) / whole;
                    EXPECT_NEAR(found[i + side * j], expected, 5 * std::sqrt(expected) + 2)
                        << kind << " z " << flat.z << " cell " << i << ", " << j;
                }
        }
}

// In the plane of a light and at its corners, where directions and solid angles end, points stay on it and nothing is
// infinite.
TEST(Light, FlatLightsInTheirPlane) {
    for (const uint kind : {LIGHT_RECTANGLE, LIGHT_TRIANGLE})
        for (const vec3 origin : {vec3{0, 0, 0}, vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{1, 1, 0}, vec3{0.5f, 0.5f, 0},
                                  vec3{0.5f, 0, 0}, vec3{2, 0.25f, 0}, vec3{0, 0, 1e-20f}}) {
            Light light = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
            light.kind = kind;
            for (const LightSampleValues& y : lightSamples(light, origin, 1 << 12)) {
                ASSERT_TRUE(std::isfinite(y.inversePdf) && y.inversePdf >= 0 && y.inversePdf < 6.2832)
                    << kind << " " << origin.x;
                ASSERT_TRUE(glm::all(glm::greaterThanEqual(y.position, vec3(0))) &&
                            glm::all(glm::lessThanEqual(y.position, vec3(1))));
            }
        }
}

// The irradiance below a light, in closed form: of a sphere pi sin^2 cos (its rim's and its middle's angles), of a unit
// square seen from a distance of one under its centre 0.7522746885; from within a sphere everything is seen, a solid
// angle of 4 pi.
TEST(Light, SamplesGiveTheIrradiance) {
    const auto irradiance = [](const Light& light, vec3 origin) {
        double sum = 0;
        const auto seen = lightSamples(light, origin, 1 << 18);
        for (const LightSampleValues& y : seen) {
            const dvec3 w = glm::normalize(dvec3(y.position) - dvec3(origin));
            sum += w.z > 0 ? w.z * double{y.inversePdf} : 0;
        }
        return sum / double(seen.size());
    };
    // Five standard errors of random points.
    EXPECT_NEAR(irradiance(sphereLight({0, 0, 2}, 1), vec3{0}), pi / 4, 3e-4);
    EXPECT_NEAR(irradiance(sphereLight({3, 0, 4}, 1), vec3{0}), pi / 25 * 0.8, 6e-5);
    EXPECT_NEAR(irradiance(sphereLight({0, 0, 1000}, 1), vec3{0}), pi * 1e-6, 1e-10);
    EXPECT_NEAR(irradiance(rectangle({-0.5f, 0.5f, 1}, {1, 0, 0}, {0, -1, 0}), vec3{0}), 0.7522746885, 2e-3);
    double whole = 0;
    const auto within = lightSamples(sphereLight({0, 0, 0}, 1), {0.1f, 0.2f, 0.3f}, 1 << 18);
    for (const LightSampleValues& y : within) whole += double{y.inversePdf};
    EXPECT_NEAR(whole / double(within.size()), 4 * pi, 0.02);
}

TEST(Light, EmitsOnTheSidesItShould) {
    std::vector<EmittedCase> xs;
    for (const uint twoSided : {0u, 1u})
        for (const vec3 w : {vec3{0, 0.6f, 0.8f}, vec3{0, 0.6f, -0.8f}}) {
            EmittedCase x{rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {0, 0, 1}, w};
            x.light.radiance = {3, 2, 1};
            x.light.twoSided = twoSided;
            xs.push_back(x);
        }
    const vec3 radiance{3, 2, 1};
    EXPECT_EQ(map<vec3>("emitted_radiance", xs), (std::vector<vec3>{radiance, vec3(0), radiance, radiance}));
}

TEST(Light, Luminance) {
    const auto ys =
        map<float>("luminance_of", std::vector<vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {2, 4, 8}});
    const std::vector<float> expected{0.2126f, 0.7152f, 0.0722f, 1, 3.8636f};
    for (std::size_t i = 0; i < ys.size(); i++) EXPECT_NEAR(ys[i], expected[i], 1e-6);
}

// The form factor of a point under the centre of a 1 x 1 light, by the midpoint rule over `side` x `side` light
// samples.
double formFactor(double height, uint side) {
    const Light light = rectangle({-0.5f, 0.5f, 0}, {1, 0, 0}, {0, -1, 0});
    const TestScene scene = sceneWith({light});
    double sum = 0;
    for (uint begin = 0; begin < side; begin += 256) {
        std::vector<vec2> us;
        for (uint row = begin; row < std::min(begin + 256, side); row++)
            for (uint i = 0; i < side; i++) us.push_back((vec2{i, row} + 0.5f) / float(side));
        for (const LightValues& y : map<LightValues>("emission_point", us, {}, scene.context())) {
            const dvec3 d = dvec3(y.position) - dvec3{0, 0, -height};
            const double distance2 = glm::dot(d, d);
            sum += d.z * -glm::dot(d, dvec3(y.normal)) / (distance2 * distance2 * pi);
        }
    }
    return sum * double{light.area} / (double(side) * side);
}

TEST(Light, FormFactors) {
    EXPECT_NEAR(formFactor(1, 256) / 0.2394564705, 1, 1e-5);
    EXPECT_NEAR(formFactor(100, 64) / 3.18299276e-5, 1, 1e-5);
    // Cells of half the height: the midpoint rule errs by exp(-2 pi * 2).
    EXPECT_NEAR(formFactor(0.001, 2048) / 0.999996726772, 1, 1e-4);
}

} // namespace
} // namespace vkpm
