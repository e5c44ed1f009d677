/// Emission of what transmits light, and of what stops a part of it.
#include "images.h"
#include "render_support.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using nlohmann::json;

/// Two faces of glass, infinitely wide for a camera above that looks straight down, from height 0 down to -1.
json slab(const json& material, bool twoSided) {
    const auto face = [&](double height, bool up) {
        return json{{"type", "rectangle"},
                    {"material", "m"},
                    {"emission", 1},
                    {"twoSided", twoSided},
                    {"corner", {-50, height, up ? 50 : -50}},
                    {"edges", {{100, 0, 0}, {0, 0, up ? -100 : 100}}}};
    };
    return {{"camera", {{"origin", {0, 5, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, 1}}, {"fieldOfView", 0.1}}},
            {"film", {{"size", {8, 8}}}},
            {"settings", {{"seed", 3}}},
            {"materials", {{"m", material}}},
            {"shapes", {face(0, true), face(-1, false)}}};
}

double brightness(const json& scene, uint integrator) {
    Scene loaded = loadJson(scene);
    loaded.settings.integrator = integrator;
    return layerMean(renderPasses(loaded, loaded.settings, 64).pixels, LAYER_COUNT);
}

// The face above, and of what is emitted within what comes through it, with all that faces reflect; radiance falls by
// the square of the index.
TEST(Emission, OfGlass) {
    const json glass{{"type", "glass"}, {"ior", 1.5}, {"attenuation", {{"color", 0.5}, {"distance", 1}}}};
    const double f = 0.04, a = 0.5;
    for (const uint integrator : {INTEGRATOR_PATH, INTEGRATOR_PHOTON}) {
        EXPECT_NEAR(brightness(slab(glass, false), integrator), 1, 1e-5);
        EXPECT_NEAR(brightness(slab(glass, true), integrator), 1 + (1 - f) / 2.25 * a / (1 - f * a), 2e-3);
    }
}

/// A cube that emits above a floor, without any other light.
Scene cubeAboveFloor(const json& material, bool twoSided) {
    json scene{
        {"camera", {{"origin", {0, 1, 3}}, {"target", {0, 0.4, 0}}, {"fieldOfView", 40}}},
        {"film", {{"size", {24, 24}}}},
        {"settings", {{"photons", 20000}, {"causticPhotons", 20000}}},
        {"materials", {{"white", {{"type", "diffuse"}, {"albedo", 0.5}}}, {"m", material}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-2, 0, 2}}, {"edges", {{4, 0, 0}, {0, 0, -4}}}, {"material", "white"}},
          {{"type", "mesh"},
           {"file", VKPM_SCENES "/cube.obj"},
           {"transform", {{{"translate", {-0.5, 0.3, -0.5}}}}},
           {"material", "m"},
           {"emission", 1},
           {"twoSided", twoSided}}}}};
    return loadJson(scene);
}

std::vector<Estimate> layersOf(const Scene& scene, uint integrator, uint passes) {
    Settings settings = scene.settings;
    settings.integrator = integrator;
    std::vector<std::vector<double>> values(LAYER_COUNT);
    for (settings.seed = 1; settings.seed <= 8; settings.seed++) {
        const Rendered image = renderPasses(scene, settings, passes);
        for (uint layer = 0; layer < LAYER_COUNT; layer++) values[layer].push_back(layerMean(image.pixels, layer));
    }
    std::vector<Estimate> result;
    for (const std::vector<double>& list : values) result.push_back(estimate(list));
    return result;
}

// Photons that start within glass are in it: what it takes away, and the index from which they come out.
TEST(Emission, WithinGlassIsACaustic) {
    const Scene scene =
        cubeAboveFloor({{"type", "glass"}, {"ior", 1.5}, {"attenuation", {{"color", 0.2}, {"distance", 0.5}}}}, true);
    for (std::size_t i = 0; i < scene.lights.size(); i++) {
        EXPECT_EQ(scene.lightMedia[2 * i], 0u);
        EXPECT_EQ(scene.lightMedia[2 * i + 1], scene.materials[scene.primitives.back().material].medium);
    }
    const Estimate photon = layersOf(scene, INTEGRATOR_PHOTON, 4)[LAYER_CAUSTIC],
                   path = layersOf(scene, INTEGRATOR_PATH, 32)[LAYER_CAUSTIC];
    const double allowed = 4 * std::hypot(photon.error, path.error);
    EXPECT_NEAR(photon.mean, path.mean, allowed + 0.01 * path.mean);
    EXPECT_LT(allowed, 0.1 * path.mean) << "the noise is too great to see an error";
}

// What stops a quarter of the light is seen, and lights, by a quarter; so does half of a texture, as half of a light.
// The floor and the wall that it lights are all before it.
TEST(Emission, OfWhatIsNotOpaque) {
    const auto lit = [](const json& opacity, double from) {
        return loadJson({{"camera", {{"origin", {0, 1, 3}}, {"target", {0, 0.4, 0}}, {"fieldOfView", 40}}},
                         {"film", {{"size", {24, 24}}}},
                         {"settings", {{"photons", 20000}}},
                         {"materials",
                          {{"white", {{"type", "diffuse"}, {"albedo", 0.5}}},
                           {"lamp", {{"type", "diffuse"}, {"albedo", 0}, {"opacity", opacity}}}}},
                         {"shapes",
                          {{{"type", "rectangle"},
                            {"corner", {-1.5, 0, 2}},
                            {"edges", {{3, 0, 0}, {0, 0, -3}}},
                            {"material", "white"}},
                           {{"type", "rectangle"},
                            {"corner", {-1.5, 0, 2}},
                            {"edges", {{0, 0, -3}, {0, 2, 0}}},
                            {"material", "white"}},
                           {{"type", "rectangle"},
                            {"corner", {from, 0.1, -1}},
                            {"edges", {{1 - from, 0, 0}, {0, 1, 0}}},
                            {"material", "lamp"},
                            {"emission", 1}}}}});
    };
    const auto expectAlike = [](const Scene& a, const Scene& b, double factor) {
        const std::vector<Estimate> one = layersOf(a, INTEGRATOR_PHOTON, 4), two = layersOf(b, INTEGRATOR_PHOTON, 4);
        for (const uint layer : {LAYER_EMISSION, LAYER_DIRECT, LAYER_INDIRECT}) {
            const double expected = factor * two[layer].mean,
                         allowed = 4 * std::hypot(one[layer].error, factor * two[layer].error);
            std::printf("%u %.6f +- %.6f, %.6f +- %.6f\n", layer, one[layer].mean, one[layer].error, expected,
                        factor * two[layer].error);
            EXPECT_NEAR(one[layer].mean, expected, allowed) << layer;
            EXPECT_LT(allowed, 0.15 * expected) << layer << ": the noise is too great to see an error";
        }
    };
    expectAlike(lit(0.25, -1), lit(1, -1), 0.25);
    writeScene(pngBytes<unsigned char>(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}), "right.png");
    expectAlike(lit({{"texture", "right.png"}, {"filter", "nearest"}}, -1), lit(1, 0), 1);
}

} // namespace
} // namespace vkpm
