/// Pictures with textures: a white one changes no bit, and the layers are those of the path tracer.
#include "images.h"
#include "render_support.h"
#include <cstring>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using nlohmann::json;

/// A box without front, with a ball; every surface of these materials.
json box(const json& floor, const json& walls, const json& ball) {
    return {
        {"camera", {{"origin", {0, 0, 3.4}}, {"target", {0, 0, 0}}, {"fieldOfView", 40}}},
        {"materials", {{"floor", floor}, {"walls", walls}, {"ball", ball}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-1, -1, 1}}, {"edges", {{2, 0, 0}, {0, 0, -2}}}, {"material", "floor"}},
          {{"type", "rectangle"}, {"corner", {-1, -1, -1}}, {"edges", {{2, 0, 0}, {0, 2, 0}}}, {"material", "walls"}},
          {{"type", "rectangle"}, {"corner", {-1, -1, 1}}, {"edges", {{0, 0, -2}, {0, 2, 0}}}, {"material", "walls"}},
          {{"type", "sphere"}, {"center", {0.3, -0.5, 0}}, {"radius", 0.45}, {"material", "ball"}},
          {{"type", "rectangle"},
           {"corner", {-0.4, 0.9, -0.4}},
           {"edges", {{0.8, 0, 0}, {0, 0, 0.8}}},
           {"emission", 6}}}}};
}

Settings small(const Scene& scene) {
    Settings settings = scene.settings;
    settings.size = {32, 32};
    settings.photons = settings.causticPhotons = 10'000;
    return settings;
}

TEST(TexturedPictures, WhiteTexturesChangeNoBit) {
    writeScene(greyPng(255), "white.png");
    const json white = {{"texture", "white.png"}};
    const auto scene = [&](const json& color, const json& number) {
        return loadJson(box({{"type", "plastic"}, {"albedo", color}, {"roughness", 0.3}},
                            {{"type", "diffuse"}, {"albedo", color}},
                            {{"type", "standard"}, {"baseColor", color}, {"metallic", number}, {"roughness", 0.5}}));
    };
    const Scene plain = scene(1, 1), textured = scene(white, white);
    ASSERT_FALSE(textured.textured.textures.empty());
    const std::vector<Pixel> a = renderPasses(plain, small(plain), 2).pixels,
                             b = renderPasses(textured, small(plain), 2).pixels;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)), 0);
}

std::vector<unsigned char> patches() {
    std::vector<unsigned char> texels;
    for (int i = 0; i < 8 * 8; i++)
        for (const int value : {(i * 37) % 256, (i * 91 + i / 8 * 50) % 256, (i / 8 + i) % 2 * 200 + 40, 255})
            texels.push_back(static_cast<unsigned char>(value));
    return texels;
}

/// Layers of both integrators agree within four standard errors and 0.3 %.
void expectAgreement(const Scene& scene, uint photonPasses, uint pathPasses) {
    Settings settings = small(scene);
    settings.radius = settings.causticRadius = 0.01f;
    const auto means = [&](uint integrator, uint passes) {
        settings.integrator = integrator;
        std::vector<std::vector<double>> layers(LAYER_COUNT + 1);
        for (uint seed = 0; seed < 6; seed++) {
            settings.seed = 100 + seed;
            const Rendered image = renderPasses(scene, settings, passes);
            EXPECT_EQ(image.nonfinite, 0u);
            for (uint layer = 0; layer <= LAYER_COUNT; layer++) layers[layer].push_back(layerMean(image.pixels, layer));
        }
        return layers;
    };
    const auto photon = means(INTEGRATOR_PHOTON, photonPasses), path = means(INTEGRATOR_PATH, pathPasses);
    for (uint layer = 0; layer <= LAYER_COUNT; layer++) {
        const Estimate a = estimate(photon[layer]), b = estimate(path[layer]);
        std::printf("layer %u: photon %.6f +- %.6f  path %.6f +- %.6f\n", layer, a.mean, a.error, b.mean, b.error);
        EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.error, b.error) + 0.004 * b.mean) << layer;
    }
}

TEST(TexturedPictures, LayersAgreeWithThePathTracer) {
    writeScene(pngBytes(8, 8, patches()), "patches.png");
    const json image = {{"texture", "patches.png"}},
               fine = {{"texture", "patches.png"}, {"transform", {{"scale", {3, 2}}}}};
    expectAgreement(
        loadJson(box({{"type", "plastic"}, {"albedo", image}, {"roughness", image}},
                     {{"type", "diffuse"}, {"albedo", fine}},
                     {{"type", "standard"}, {"baseColor", fine}, {"metallic", image}, {"roughness", fine}})),
        16, 32);
}

} // namespace
} // namespace vkpm
