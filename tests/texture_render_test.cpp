/// Pictures with textures: a white one changes no bit, and the layers are those of the path tracer.
#include "draw.h"
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
        for (uint seed = 0; seed < 5; seed++) {
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
    SKIP_UNLESS_DRAWN(0);
    writeScene(pngBytes(8, 8, patches()), "patches.png");
    const json image = {{"texture", "patches.png"}},
               fine = {{"texture", "patches.png"}, {"transform", {{"scale", {3, 2}}}}};
    expectAgreement(
        loadJson(box({{"type", "plastic"}, {"albedo", image}, {"roughness", image}},
                     {{"type", "diffuse"}, {"albedo", fine}},
                     {{"type", "standard"}, {"baseColor", fine}, {"metallic", image}, {"roughness", fine}})),
        16, 48);
}

/// A floor below a lamp, and sheets between them that the camera does not see.
Scene sheets(int count, const json& material,
             const json& lamp = {{"type", "rectangle"},
                                 {"corner", {-0.5, 3, -0.5}},
                                 {"edges", {{1, 0, 0}, {0, 0, 1}}},
                                 {"emission", 9}}) {
    json scene = {
        {"camera", {{"origin", {0, 0.9, 1}}, {"target", {0, 0, 0}}, {"fieldOfView", 60}}},
        {"materials", {{"white", {{"type", "diffuse"}, {"albedo", 0.8}}}, {"sheet", material}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-2, 0, 2}}, {"edges", {{4, 0, 0}, {0, 0, -4}}}, {"material", "white"}},
          lamp}}};
    for (int i = 0; i < count; i++)
        scene["shapes"].push_back({{"type", "rectangle"},
                                   {"corner", {-3, 1 + 0.01 * i, 3}},
                                   {"edges", {{6, 0, 0}, {0, 0, -6}}},
                                   {"material", "sheet"}});
    return loadJson(scene);
}

double meanOf(const Scene& scene, uint integrator, uint layer) {
    Settings settings = small(scene);
    settings.integrator = integrator;
    settings.layers = 1u << layer;
    settings.photons = settings.causticPhotons = 500'000;
    settings.radius = 0.2f;
    return layerMean(renderPasses(scene, settings, 4).pixels, layer);
}

// Light samples and photons alike: sheets of black that stop a part.
TEST(TexturedPictures, SheetsLetTheirPartThrough) {
    const json black = {{"type", "diffuse"}, {"albedo", 0}};
    const auto opaque = [&](double opacity) {
        json material = black;
        material["opacity"] = opacity;
        return material;
    };
    writeScene(pngBytes<unsigned char>(1, 1, {255, 255, 255, 51}), "fifth.png");
    json textured = black;
    textured["opacity"] = {{"texture", "fifth.png"}, {"channel", "a"}};
    for (const auto& [integrator, layer] :
         {std::pair{INTEGRATOR_PHOTON, LAYER_DIRECT}, {INTEGRATOR_PHOTON_MAP, LAYER_INDIRECT}}) {
        const double bare = meanOf(sheets(0, black), integrator, layer);
        ASSERT_GT(bare, 0.1);
        EXPECT_NEAR(meanOf(sheets(1, opaque(0.5)), integrator, layer) / bare, 0.5, 0.015) << integrator;
        EXPECT_NEAR(meanOf(sheets(1, textured), integrator, layer) / bare, 0.8, 0.015) << integrator;
        EXPECT_NEAR(meanOf(sheets(10, opaque(0.1)), integrator, layer) / bare, std::pow(0.9, 10), 0.015) << integrator;
    }
    const auto direct = [](const Scene& scene) { return meanOf(scene, INTEGRATOR_PHOTON, LAYER_DIRECT); };
    EXPECT_EQ(direct(sheets(100, opaque(0.5))), 0);
    textured["cutoff"] = 0.25;
    EXPECT_EQ(direct(sheets(1, textured)), direct(sheets(0, black)));
    textured["cutoff"] = 0.2;
    EXPECT_EQ(direct(sheets(1, textured)), 0);
}

// A blended sheet, a ball and walls with holes, lit from both sides.
TEST(TexturedPictures, LayersBehindSheetsAgreeWithThePathTracer) {
    SKIP_UNLESS_DRAWN(1);
    writeScene(pngBytes(8, 8, patches()), "patches.png");
    const json hole = {{"texture", "patches.png"}, {"channel", "g"}};
    json ball = {{"type", "metal"}, {"preset", "gold"}, {"roughness", 0.3}, {"opacity", 0.6}},
         walls = {{"type", "diffuse"}, {"albedo", 0.8}, {"opacity", hole}, {"cutoff", 0.5}};
    json scene = box({{"type", "diffuse"}, {"albedo", 0.7}}, walls, ball);
    scene["materials"]["sheet"] = {{"type", "diffuse"}, {"albedo", {0.9, 0.8, 0.3}}, {"opacity", 0.3}};
    scene["shapes"].push_back({{"type", "rectangle"},
                               {"corner", {-0.8, -0.2, 0.6}},
                               {"edges", {{1.5, 0, 0}, {0, 0, -1.2}}},
                               {"material", "sheet"}});
    expectAgreement(loadJson(scene), 16, 32);
}

// Photons lie on what is there alone: discs of 0.1 on walls whose holes are 0.25 wide. With the holes counted as walls
// indirect light is 13 % too dark.
TEST(TexturedPictures, DiscsEndAtHoles) {
    writeScene(pngBytes(8, 8, patches()), "patches.png");
    const json wall = {{"type", "diffuse"},
                       {"albedo", 0.8},
                       {"opacity", {{"texture", "patches.png"}, {"channel", "g"}}},
                       {"cutoff", 0.5}};
    json room = box(wall, wall, wall);
    room["shapes"].erase(3); // the ball
    const Scene scene = loadJson(room);
    Settings settings = small(scene);
    settings.radius = 0.1f;
    const auto indirect = [&](uint integrator, uint passes) {
        settings.integrator = integrator;
        std::vector<double> means;
        for (settings.seed = 0; settings.seed < 5; settings.seed++)
            means.push_back(layerMean(renderPasses(scene, settings, passes).pixels, LAYER_INDIRECT));
        return estimate(means);
    };
    const Estimate photon = indirect(INTEGRATOR_PHOTON, 8), path = indirect(INTEGRATOR_PATH, 64);
    EXPECT_NEAR(photon.mean, path.mean, 4 * std::hypot(photon.error, path.error) + 0.01 * path.mean);
    EXPECT_LT(path.error, 0.01 * path.mean);
}

json standardWith(const json& color, const json& transmission, double roughness, double metallic = 0) {
    return {{"type", "standard"},
            {"baseColor", color},
            {"metallic", metallic},
            {"roughness", roughness},
            {"transmission", transmission}};
}

// Glass in part: a rough ball of patches, half of it metal, and a sheet of smooth ones before it.
TEST(TexturedPictures, LayersOfWhatTransmitsAPartAgreeWithThePathTracer) {
    SKIP_UNLESS_DRAWN(1);
    writeScene(pngBytes(8, 8, patches()), "patches.png");
    json scene = box({{"type", "diffuse"}, {"albedo", 0.7}}, {{"type", "diffuse"}, {"albedo", 0.8}},
                     standardWith({0.9, 0.5, 0.3}, {{"texture", "patches.png"}}, 0.4, 0.5)),
         sheet = standardWith({0.9, 0.8, 0.7}, 0.6, 0.02);
    sheet["thin"] = true;
    sheet["specular"] = {{"texture", "patches.png"}, {"channel", "r"}};
    scene["materials"]["sheet"] = sheet;
    scene["shapes"].push_back({{"type", "rectangle"},
                               {"corner", {-0.8, -0.2, 0.6}},
                               {"edges", {{1.5, 0, 0}, {0, 0, -1.2}}},
                               {"material", "sheet"}});
    expectAgreement(loadJson(scene), 24, 48);
}

// A sheet that does not reflect by its surface: what goes through is light of the lamp through glass.
TEST(TexturedPictures, SheetsTransmitTheirPart) {
    writeScene(greyPng(128), "half.png");
    const double half = 128 / 255.0;
    const double bare = meanOf(sheets(0, {{"type", "diffuse"}, {"albedo", 0}}), INTEGRATOR_PHOTON, LAYER_DIRECT);
    const json textured = {{"texture", "half.png"}};
    for (const auto& [transmission, metallic, part] :
         {std::tuple{json(0.25), json(0), 0.25}, {textured, json(0), half}, {textured, textured, half * (1 - half)}}) {
        json sheet = standardWith(0.8, transmission, 0);
        sheet.update({{"metallic", metallic}, {"specular", 0}, {"ior", 1}, {"thin", true}});
        EXPECT_NEAR(meanOf(sheets(1, sheet), INTEGRATOR_LIGHT, LAYER_CAUSTIC) / bare, 0.8 * part, 0.003) << sheet;
    }
}

// White balls that transmit a part vanish before a white sky.
TEST(TexturedPictures, WhatTransmitsAPartLosesNothing) {
    SKIP_UNLESS_DRAWN(0);
    for (json material : {standardWith(1, 0.4, 0.01), standardWith(1, 0.7, 0.01, 0.5), standardWith(1, 0.5, 0.01)}) {
        if (material["transmission"] == 0.5) material["thin"] = true;
        const Scene scene =
            loadJson({{"camera", {{"origin", {0, 0, 3}}, {"target", {0, 0, 0}}, {"fieldOfView", 30}}},
                      {"environment", {{"radiance", 1}}},
                      {"materials", {{"m", material}}},
                      {"shapes", {{{"type", "sphere"}, {"radius", 1}, {"center", {0, 0, 0}}, {"material", "m"}}}}});
        const double mean = layerMean(renderPasses(scene, small(scene), 32).pixels, LAYER_COUNT);
        EXPECT_NEAR(mean, 1, 5e-3) << material;
    }
}

// What photons of a screen bring to a floor is what light samples do.
TEST(TexturedPictures, PhotonsHaveTheFluxOfTexels) {
    std::vector<unsigned char> texels(8 * 8 * 4, 255);
    for (std::size_t i = 0; i < texels.size(); i++)
        if (i % 4 != 3) texels[i] = i / 4 % 8 == 2 ? 255 : static_cast<unsigned char>(i % 97);
    writeScene(pngBytes(8, 8, texels), "picture.png");
    for (const char* shape : {"rectangle", "sphere"}) {
        json lamp = {{"type", "rectangle"}, {"corner", {-0.5, 3, -0.5}}, {"edges", {{1, 0, 0}, {0, 0, 1}}}};
        if (shape == std::string{"sphere"}) lamp = {{"type", "sphere"}, {"center", {0, 2, 0}}, {"radius", 0.5}};
        lamp["emission"] = {{"texture", "picture.png"}, {"factor", 9}};
        const Scene scene = sheets(0, {{"type", "diffuse"}, {"albedo", 0}}, lamp);
        const double direct = meanOf(scene, INTEGRATOR_PHOTON, LAYER_DIRECT),
                     photons = meanOf(scene, INTEGRATOR_PHOTON_MAP, LAYER_INDIRECT);
        EXPECT_NEAR(direct / 0.8 / photons, 1, 0.04) << shape; // the map shows what white would
    }
}

// A screen with a picture, whose bright places are few, lights the box; so does a ball with one.
TEST(TexturedPictures, ScreensLightARoom) {
    SKIP_UNLESS_DRAWN(0);
    std::vector<unsigned char> texels;
    for (int i = 0; i < 16 * 12; i++)
        for (const int value : {i % 16 == 5 ? 250 : 20, i / 16 == 3 ? 220 : 10, i * 7 % 60, 255})
            texels.push_back(static_cast<unsigned char>(value));
    writeScene(pngBytes(16, 12, texels), "picture.png");
    json scene = box({{"type", "plastic"}, {"albedo", 0.6}, {"roughness", 0.4}}, {{"type", "diffuse"}, {"albedo", 0.7}},
                     {{"type", "diffuse"}, {"albedo", 0}});
    scene["shapes"][3]["emission"] = {{"texture", "picture.png"}, {"factor", {1, 2, 3}}};
    scene["shapes"][4] = {{"type", "rectangle"},
                          {"corner", {0.9, -0.7, 0.6}},
                          {"edges", {{0, 0, -1.2}, {0, 1.4, 0}}},
                          {"twoSided", true},
                          {"emission", {{"texture", "picture.png"}, {"factor", 8}}}};
    const Scene loaded = loadJson(scene);
    EXPECT_EQ(loaded.lights.size(), 1 + 16 * 12u);
    expectAgreement(loaded, 16, 48);
}

} // namespace
} // namespace vkpm
