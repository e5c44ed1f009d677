/// Coarse meshes with smooth normals against what they stand for: the light of a sphere, without stairs, for light
/// samples and photons alike, and furnaces that lose none.
#include "draw.h"
#include "render_support.h"
#include "shared_layers.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <unistd.h>

namespace vkpm {
namespace {

using glm::uvec3;
using nlohmann::json;
namespace fs = std::filesystem;

/// An icosahedron, each face split into four `splits` times, with corners on the unit sphere, as an OBJ file with its
/// normals.
fs::path ballFile(int splits) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    std::vector<vec3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<uvec3> faces{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (; splits > 0; splits--) {
        std::vector<uvec3> finer;
        for (const uvec3 f : faces) {
            const uint n = static_cast<uint>(points.size());
            for (int i = 0; i < 3; i++)
                points.push_back(glm::normalize(points[f[i]]) + glm::normalize(points[f[(i + 1) % 3]]));
            for (const uvec3 part : {uvec3{f.x, n, n + 2}, {f.y, n + 1, n}, {f.z, n + 2, n + 1}, {n, n + 1, n + 2}})
                finer.push_back(part);
        }
        faces = finer;
    }
    const fs::path file = fs::temp_directory_path() /
                          ("vkpm_ball_" + std::to_string(::getpid()) + "_" + std::to_string(faces.size()) + ".obj");
    std::ofstream out(file);
    for (const vec3 point : points) {
        const vec3 p = glm::normalize(point);
        out << "v " << p.x << ' ' << p.y << ' ' << p.z << "\nvn " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    for (const uvec3 f : faces)
        out << "f " << f.x + 1 << "//" << f.x + 1 << ' ' << f.y + 1 << "//" << f.y + 1 << ' ' << f.z + 1 << "//"
            << f.z + 1 << '\n';
    return file;
}

json ball(int splits, double scale = 1) {
    return {{"name", "ball"},      {"type", "mesh"}, {"file", ballFile(splits).string()},
            {"material", "white"}, {"smooth", true}, {"transform", {{{"scale", scale}}}}};
}

const glm::dvec3 toSun = glm::normalize(glm::dvec3(0.3, 1, 0.4));
const double irradiance = 3; // across the sun's rays

/// A ball under a small sun, seen across its rays.
Scene underSun(int splits) {
    const double distance = 1000, radius = 1,
                 radiance = irradiance / (std::numbers::pi * radius * radius / (distance * distance));
    return loadJson({{"camera", {{"origin", {3, 0.4, -2}}, {"target", {0, 0, 0}}, {"fieldOfView", 36}}},
                     {"materials", {{"white", {{"type", "diffuse"}, {"albedo", 0.6}}}}},
                     {"shapes",
                      {ball(splits),
                       {{"type", "sphere"},
                        {"center", {distance * toSun.x, distance * toSun.y, distance * toSun.z}},
                        {"radius", radius},
                        {"emission", radiance}}}}});
}

/// Mean of a layer's first channel, over pi times the irradiance, by the cosine to the sun of the shading normal: below
/// the horizon, by the horizon, and three more parts.
std::array<double, 5> byCosine(const std::vector<Pixel>& pixels, uint layer, bool expected) {
    const std::array<double, 5> bounds{0, 0.15, 0.4, 0.7, 1.01};
    std::array<double, 5> sums{}, counts{};
    for (const Pixel& pixel : pixels) {
        if (pixel.mean.covered < 1) continue;
        const double cosine = glm::dot(glm::normalize(glm::dvec3(pixel.mean.normal)), toSun);
        const std::size_t bin =
            std::size_t(std::ranges::find_if(bounds, [&](double bound) { return cosine < bound; }) - bounds.begin());
        sums[bin] +=
            expected ? std::max(0.0, cosine) : double(pixel.mean.layers[layer].x) * std::numbers::pi / irradiance;
        counts[bin]++;
    }
    for (std::size_t i = 0; i < 5; i++) sums[i] /= std::max(counts[i], 1.0);
    return sums;
}

TEST(Terminator, LightSamplesSeeTheSphere) {
    for (const int splits : {0, 1, 3}) {
        const Scene scene = underSun(splits);
        const Rendered image = renderPasses(scene, {.size = {96, 96}, .integrator = INTEGRATOR_DIRECT}, 16);
        double worst = 0;
        std::size_t seen = 0;
        for (const Pixel& pixel : image.pixels) {
            if (pixel.mean.covered < 1) continue;
            seen++;
            const double cosine = std::max(0.0, glm::dot(glm::dvec3(pixel.mean.normal), toSun));
            worst = std::max(
                worst,
                std::abs(double(pixel.mean.layers[LAYER_DIRECT].x) * std::numbers::pi / (0.6 * irradiance) - cosine));
        }
        EXPECT_GT(seen, 1500u);
        EXPECT_LT(worst, 0.015) << splits; // of the light at noon; pixels on the horizon are half dark
    }
}

TEST(Terminator, PhotonsSeeTheSphere) {
    SKIP_UNLESS_DRAWN(0);
    for (const int splits : {0, 1, 3}) {
        const Scene scene = underSun(splits);
        Settings settings{.size = {64, 64}, .photons = 1'000'000, .integrator = INTEGRATOR_PHOTON_MAP};
        settings.radius = 0.01f; // discs at edges lose what lies beyond them
        std::array<std::vector<double>, 5> ratios;
        for (uint seed = 0; seed < 8; seed++) {
            settings.seed = seed;
            const Rendered image = renderPasses(scene, settings, 1);
            const auto found = byCosine(image.pixels, LAYER_INDIRECT, false),
                       expected = byCosine(image.pixels, LAYER_INDIRECT, true);
            EXPECT_LT(found[0], 0.02) << splits;
            for (std::size_t i = 1; i < 5; i++) ratios[i].push_back(found[i] / expected[i]);
        }
        for (std::size_t i = 1; i < 5; i++) {
            const Estimate ratio = estimate(ratios[i]);
            std::printf("%d %zu %.4f +- %.4f\n", splits, i, ratio.mean, ratio.error);
            EXPECT_NEAR(ratio.mean, 1, 0.03 + 3 * ratio.error) << splits << ": " << i;
            EXPECT_LT(ratio.error, 0.04);
        }
    }
}

/// All surfaces emit E and reflect a: the ball bulges, and the room is hollow.
void expectFurnace(uint integrator, double tolerance) {
    json room = ball(1, 5), inner = ball(0);
    room["emission"] = inner["emission"] = 0.5;
    room["twoSided"] = true;
    const Scene scene = loadJson({{"camera", {{"origin", {0, 0, 3}}, {"target", {0, 0, 0}}, {"fieldOfView", 60}}},
                                  {"materials", {{"white", {{"type", "diffuse"}, {"albedo", 0.5}}}}},
                                  {"shapes", {room, inner}}});
    Settings settings{.size = {48, 48}, .photons = 200'000, .integrator = integrator};
    settings.radius = 0.05f;
    settings.gatherRays = 1;
    const Rendered image = renderPasses(scene, settings, 32);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_EMISSION), 0.5, 1e-6);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_DIRECT), 0.25, 0.25 * tolerance);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_INDIRECT), 0.25, 0.25 * tolerance);
    EXPECT_EQ(image.nonfinite, 0u);
}

TEST(Terminator, FurnaceOfThePathTracer) { expectFurnace(INTEGRATOR_PATH, 0.006); }
TEST(Terminator, FurnaceOfPhotons) {
    SKIP_UNLESS_DRAWN(1);
    expectFurnace(INTEGRATOR_PHOTON, 0.02);
}

// In a room under a wide lamp, with a glass ball above: the same paths from either end.
TEST(Terminator, LayersAgreeWithThePathTracer) {
    const auto rectangle = [](json corner, json u, json v) {
        return json{{"type", "rectangle"}, {"corner", corner}, {"edges", {u, v}}, {"material", "grey"}};
    };
    json lamp = rectangle({-1.5, 2.9, -1.5}, {3, 0, 0}, {0, 0, 3});
    lamp["emission"] = 3;
    const json glass{{"type", "sphere"}, {"center", {0.8, 1.5, 0.4}}, {"radius", 0.6}, {"material", "glass"}};
    const Scene scene =
        loadJson({{"camera", {{"origin", {2.5, 1, 2.7}}, {"target", {0, 0, 0}}, {"fieldOfView", 50}}},
                  {"materials",
                   {{"white", {{"type", "diffuse"}, {"albedo", 0.9}}},
                    {"grey", {{"type", "diffuse"}, {"albedo", 0.5}}},
                    {"glass", {{"type", "glass"}, {"ior", 1.5}}}}},
                  {"shapes",
                   {rectangle({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), rectangle({-3, 3, -3}, {6, 0, 0}, {0, 0, 6}),
                    rectangle({-3, -1, -3}, {6, 0, 0}, {0, 4, 0}), rectangle({-3, -1, 3}, {0, 0, -6}, {0, 4, 0}),
                    ball(0), lamp, glass}}});
    Settings settings{.size = {48, 48}, .photons = 50'000, .causticPhotons = 50'000};
    settings.radius = settings.causticRadius = 0.03f;
    std::array<std::vector<double>, LAYER_COUNT> photon, path;
    for (uint seed = 0; seed < 6; seed++) {
        settings.seed = seed;
        settings.integrator = INTEGRATOR_PHOTON;
        const Rendered a = renderPasses(scene, settings, 8);
        settings.integrator = INTEGRATOR_PATH;
        const Rendered b = renderPasses(scene, settings, 128);
        for (uint layer = 0; layer < LAYER_COUNT; layer++)
            photon[layer].push_back(layerMean(a.pixels, layer)), path[layer].push_back(layerMean(b.pixels, layer));
    }
    for (const uint layer : {LAYER_DIRECT, LAYER_CAUSTIC, LAYER_INDIRECT, LAYER_SPECULAR}) {
        const Estimate a = estimate(photon[layer]), b = estimate(path[layer]);
        const double allowed = 4 * std::hypot(a.error, b.error) + 0.006 * b.mean;
        std::printf("layer %u: photon %.6f +- %.6f  path %.6f +- %.6f\n", layer, a.mean, a.error, b.mean, b.error);
        EXPECT_NEAR(a.mean, b.mean, allowed) << layer;
        EXPECT_LT(allowed, (layer == LAYER_SPECULAR ? 0.1 : 0.05) * b.mean) << layer;
    }
}

} // namespace
} // namespace vkpm
