/// Light tracing against the path tracer, which finds the same paths from the other end.
#include "draw.h"
#include "render_support.h"
#include "shared_scene.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using nlohmann::json;

const uint repetitions = 16;
const uint columns = 4, rows = 4; // of regions

// Means of the caustic layer over each region, then over the image.
std::vector<double> regionMeans(const std::vector<Pixel>& pixels, uvec2 size) {
    std::vector<std::vector<Pixel>> regions(columns * rows);
    for (uint i = 0; i < pixels.size(); i++) {
        const uint column = i % size.x * columns / size.x, row = i / size.x * rows / size.y;
        regions[row * columns + column].push_back(pixels[i]);
    }
    regions.push_back(pixels);
    std::vector<double> means;
    for (const std::vector<Pixel>& region : regions) means.push_back(layerMean(region, LAYER_CAUSTIC));
    return means;
}

// Of regionMeans, over independent seeds.
std::vector<Estimate> renderSeeds(const Scene& scene, Settings settings, uint passes) {
    std::vector<std::vector<double>> values(columns * rows + 1);
    for (uint seed = 0; seed < repetitions; seed++) {
        settings.seed = 300 + seed;
        const Rendered image = renderPasses(scene, settings, passes);
        EXPECT_EQ(image.nonfinite, 0u);
        const std::vector<double> means = regionMeans(image.pixels, settings.size);
        for (std::size_t i = 0; i < means.size(); i++) values[i].push_back(means[i]);
    }
    std::vector<Estimate> estimates;
    for (const std::vector<double>& list : values) estimates.push_back(estimate(list));
    return estimates;
}

// A sample of the path tracer hits a light or is black, so that its variance is at most its mean times the brightest
// light (Bhatia & Davis 2000). Where hits are few their own spread would say less; one hit more or less does not count.
void expectAgreement(const char* name, const Scene& scene, uint pathPasses, uint lightPasses) {
    Settings settings = scene.settings;
    settings.size = {48, 48};
    settings.causticPhotons = 20'000;
    settings.layers = 1u << LAYER_CAUSTIC;
    settings.integrator = INTEGRATOR_LIGHT;
    const std::vector<Estimate> light = renderSeeds(scene, settings, lightPasses);
    settings.integrator = INTEGRATOR_PATH;
    const std::vector<Estimate> path = renderSeeds(scene, settings, pathPasses);

    float brightest = 0;
    for (const Light& lamp : scene.lights)
        brightest = std::max({brightest, lamp.radiance.x, lamp.radiance.y, lamp.radiance.z});
    double farthest = 0;
    for (std::size_t i = 0; i < light.size(); i++) {
        const double samples = 48.0 * 48 / (i < columns * rows ? columns * rows : 1) * pathPasses * repetitions;
        const double hit = brightest / samples;
        const double error = std::hypot(light[i].error, std::sqrt(light[i].mean * hit));
        EXPECT_NEAR(light[i].mean, path[i].mean, 4 * error + hit) << name << ", region " << i;
        if (error > 0) farthest = std::max(farthest, std::abs(light[i].mean - path[i].mean) / error);
    }
    const Estimate a = light.back(), b = path.back();
    std::printf("%-12s light %.6f +- %.6f  path %.6f +- %.6f  z %+.2f, of regions at most %.2f\n", name, a.mean,
                a.error, b.mean, b.error, zScore(a, b), farthest);
    EXPECT_GT(a.mean, 15 * a.error);
}

TEST(LightTracing, BoxAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(0);
    expectAgreement("box", shippedScene("box"), 128, 8);
}
TEST(LightTracing, RingAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(1);
    expectAgreement("ring", shippedScene("ring"), 128, 8);
}
TEST(LightTracing, PoolAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(0);
    expectAgreement("pool", shippedScene("pool"), 128, 8);
}

const char* const octahedron = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                               "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

// Under a mirror and seen at a wide angle, in different colours: an octahedron with the shading normals of a ball, a
// ball, and a sheet whose back alone is lit, behind which there is more floor.
json stillLife() {
    const auto diffuse = [](json albedo) { return json{{"type", "diffuse"}, {"albedo", albedo}}; };
    return {
        {"camera", {{"origin", {0.1, 0.5, 1.2}}, {"target", {0, 0.2, 0}}, {"up", {0.1, 1, 0}}, {"fieldOfView", 95}}},
        {"materials",
         {{"white", diffuse(0.8)},
          {"red", diffuse({0.7, 0.2, 0.1})},
          {"green", diffuse({0.2, 0.6, 0.3})},
          {"blue", diffuse({0.1, 0.2, 0.9})},
          {"mirror", {{"type", "mirror"}, {"reflectance", {0.9, 0.8, 0.7}}}}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-3, 0, 3}}, {"edges", {{6, 0, 0}, {0, 0, -6}}}, {"material", "white"}},
          {{"type", "rectangle"},
           {"corner", {-1, 1.2, -1}},
           {"edges", {{2, 0, 0}, {0, 0.1, 2}}},
           {"material", "mirror"}},
          {{"type", "mesh"},
           {"file", writeScene(octahedron, "octahedron.obj").string()},
           {"smooth", true},
           {"material", "red"},
           {"transform", {{{"scale", 0.3}}, {{"translate", {-0.4, 0.35, 0.2}}}}}},
          {{"type", "sphere"}, {"center", {0.5, 0.25, 0}}, {"radius", 0.25}, {"material", "green"}},
          {{"type", "rectangle"},
           {"corner", {0, 0.1, 0.6}},
           {"edges", {{0.5, 0, 0}, {0, 0.3, 0.2}}},
           {"material", "blue"}},
          {{"type", "rectangle"},
           {"corner", {-0.3, 0.6, -0.5}},
           {"edges", {{0, 0, 0.3}, {0.3, 0, 0}}},
           {"emission", {20, 18, 15}}},
          {{"type", "sphere"}, {"center", {0.8, 0.9, 0.4}}, {"radius", 0.1}, {"emission", {5, 6, 7}}}}}};
}

TEST(LightTracing, SmoothAndHiddenSurfacesAgreeWithThePathTracer) {
    SKIP_UNLESS_DRAWN(1);
    expectAgreement("still life", loadJson(stillLife()), 128, 8);
}

TEST(LightTracing, ShowsTheCausticLayerAndTheFirstSurfaceAlone) {
    const Scene scene = shippedScene("box");
    Settings settings = scene.settings;
    settings.size = {24, 24};
    settings.causticPhotons = 1000;
    settings.pixelSamples = 1; // light tracing has one path for each pixel
    const std::vector<Pixel> photon = renderPasses(scene, settings, 2).pixels;
    settings.integrator = INTEGRATOR_LIGHT;
    const Rendered light = renderPasses(scene, settings, 2);
    EXPECT_EQ(light.caustic.emitted, 2000u);
    EXPECT_EQ(light.global.emitted, 0u);
    for (const uint layer : {LAYER_EMISSION, LAYER_DIRECT, LAYER_SPECULAR, LAYER_INDIRECT})
        EXPECT_EQ(layerMean(light.pixels, layer), 0) << layer;
    EXPECT_GT(layerMean(light.pixels, LAYER_CAUSTIC), 0);
    for (std::size_t i = 0; i < photon.size(); i++) {
        EXPECT_EQ(light.pixels[i].mean.albedo, photon[i].mean.albedo);
        EXPECT_EQ(light.pixels[i].mean.normal, photon[i].mean.normal);
        EXPECT_EQ(light.pixels[i].mean.depth, photon[i].mean.depth);
    }
}

TEST(LightTracing, IsLeftOutWhereThereAreNoCaustics) {
    const Scene scene = shippedScene("diffuse_box");
    Settings settings = scene.settings;
    settings.size = {8, 8};
    settings.integrator = INTEGRATOR_LIGHT;
    EXPECT_FALSE(tracesLight(sceneFeatures(scene, settings), settings));
    const Rendered image = renderPasses(scene, settings, 1);
    EXPECT_EQ(image.caustic.emitted, 0u);
    EXPECT_EQ(layerMean(image.pixels, LAYER_COUNT), 0);
}

} // namespace
} // namespace vkpm
