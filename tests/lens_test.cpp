/// Lenses: sharp where they are focused, blurred by their formula elsewhere, the same from either end of a path.
#include "judge.h"
#include "render/features.h"
#include "render_support.h"
#include "scene/camera_json.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The left half of the plane z = -4 shines, seen from the origin.
json edgeScene() {
    return json::parse(R"({
        "camera": {"origin": [0, 0, 0], "target": [0, 0, -1], "fieldOfView": 2.5},
        "film": {"size": [64, 16]}, "settings": {"layers": ["emission", "depth"]},
        "shapes": [{"type": "rectangle", "corner": [-9, -9, -4], "edges": [[9, 0, 0], [0, 18, 0]], "emission": 1}]})");
}

std::vector<Pixel> render(const json& scene, uint passes) {
    const Scene loaded = loadJson(scene);
    return renderPasses(loaded, loaded.settings, passes).pixels;
}

double emissionOf(const Pixel& pixel) { return pixel.mean.layers[LAYER_EMISSION].x; }

TEST(Lens, OfRadiusZeroIsAPinhole) {
    json scene = edgeScene();
    const std::vector<Pixel> pinhole = render(scene, 2);
    scene["camera"]["aperture"] = 0;
    scene["camera"]["focusDistance"] = 2;
    EXPECT_EQ(sceneFeatures(loadJson(scene), {}).hasLens, false);
    const std::vector<Pixel> lens = render(scene, 2);
    for (std::size_t i = 0; i < lens.size(); i++) EXPECT_EQ(emissionOf(lens[i]), emissionOf(pinhole[i]));
}

// The edge lies between two columns of pixels.
TEST(Lens, SeesSharplyWhereItIsFocused) {
    json scene = edgeScene();
    scene["camera"]["aperture"] = 0.5;
    scene["camera"]["focusDistance"] = 4;
    const std::vector<Pixel> pixels = render(scene, 4);
    for (std::size_t i = 0; i < pixels.size(); i++) {
        EXPECT_EQ(emissionOf(pixels[i]), i % 64 < 32 ? 1 : 0) << i;
        if (i % 64 < 32) {
            EXPECT_NEAR(pixels[i].mean.depth, 4, 1e-5); // along the axis, from wherever on the lens
        }
    }
}

// A point at depth z is seen as a disc of radius R |1 / f - 1 / z| on the plane at distance 1; an edge as that disc's
// integral, whose variance is a quarter of the radius squared.
TEST(Lens, BlursByItsFormula) {
    json scene = edgeScene();
    scene["camera"]["aperture"] = 0.2;
    const double tangent = std::tan(1.25 * pi / 180);
    for (const double focus : {2.0, 3.0, 40.0}) {
        scene["camera"]["focusDistance"] = focus;
        const std::vector<Pixel> pixels = render(scene, 256);
        std::vector<double> columns(64);
        for (std::size_t i = 0; i < pixels.size(); i++) columns[i % 64] += emissionOf(pixels[i]) / 16;
        double mean = 0, square = 0; // of where the edge is
        for (uint x = 0; x + 1 < 64; x++) {
            const double place = (double(x) + 1 - 32) * 4 * tangent * 2 / 64, fall = columns[x] - columns[x + 1];
            mean += fall * place;
            square += fall * place * place;
        }
        const double pixel = 8 * tangent / 64, radius = 0.2 * std::abs(1 / focus - 0.25);
        const double variance = square - mean * mean - pixel * pixel / 6; // of two box filters
        std::printf("focus %g: radius %.5f, by formula %.5f\n", focus, 2 * std::sqrt(variance), radius);
        EXPECT_NEAR(mean, 0, 0.3 * pixel);
        EXPECT_NEAR(2 * std::sqrt(variance), radius, 0.03 * radius + 2e-4) << focus;
    }
}

TEST(Lens, SeesAConstantSkyAsItIs) {
    json scene = edgeScene();
    scene["camera"]["aperture"] = 0.3;
    scene["camera"]["target"] = {0, 0, 1};
    scene["environment"]["radiance"] = {1, 2, 3};
    for (const Pixel& pixel : render(scene, 2)) EXPECT_EQ(pixel.mean.layers[LAYER_EMISSION], vec3(1, 2, 3));
}

// A caustic: photons connected to the lens against photons gathered and against paths from it.
TEST(Lens, LightTracingSeesThroughIt) {
    const Scene scene = loadJson(json::parse(R"({
        "camera": {"origin": [0, 2, 5], "target": [0, -0.6, 0], "fieldOfView": 40, "aperture": 0.3, "focusDistance": 5.6},
        "film": {"size": [32, 24]},
        "settings": {"causticPhotons": 20000, "causticRadius": 0.04, "layers": ["caustic"]},
        "lights": [{"type": "sun", "direction": [0.5, 1, 0.4], "irradiance": 2, "angle": 16}],
        "materials": {"white": {"type": "diffuse", "albedo": 0.7}, "glass": {"type": "glass", "ior": 1.5}},
        "shapes": [{"type": "rectangle", "corner": [-4, -1, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "white"},
                   {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "glass"}]})"));
    const uint integrators[]{INTEGRATOR_LIGHT, INTEGRATOR_PHOTON, INTEGRATOR_PATH}, passes[]{12, 12, 128};
    std::vector<Pixel> pictures[3];
    for (int which = 0; which < 3; which++) {
        Settings settings = scene.settings;
        settings.integrator = integrators[which];
        pictures[which] = renderPasses(scene, settings, passes[which]).pixels;
    }
    const double light = layerMean(pictures[0], LAYER_CAUSTIC), photon = layerMean(pictures[1], LAYER_CAUSTIC),
                 path = layerMean(pictures[2], LAYER_CAUSTIC);
    std::printf("caustic: light %.5f photon %.5f path %.5f\n", light, photon, path);
    EXPECT_NEAR(photon / light, 1, 0.03);
    EXPECT_NEAR(path / light, 1, 0.3); // of few bright paths
}

// As photographers say it, and as the window writes it.
TEST(Lens, IsSaidInTwoWays) {
    json scene = edgeScene();
    scene["camera"]["fStop"] = 2;
    scene["camera"]["focalLength"] = 50;
    EXPECT_FLOAT_EQ(loadJson(scene).view.lens.aperture, 0.0125f);
    scene["camera"]["unit"] = 0.01;
    scene["camera"]["focusDistance"] = 3;
    View view = loadJson(scene).view;
    EXPECT_FLOAT_EQ(view.lens.aperture, 1.25f);
    EXPECT_FLOAT_EQ(view.lens.focus, 3);
    EXPECT_TRUE(loadText(withCamera(scene.dump(), view)).view == view);
    scene["camera"]["aperture"] = 1;
    EXPECT_THAT(errorOf(scene), HasSubstr("/camera/aperture: found \"aperture\" beside"));
    scene["camera"].erase("aperture");
    scene["camera"].erase("fStop");
    EXPECT_THAT(errorOf(scene), HasSubstr("/camera/focalLength: found one of"));
}

} // namespace
} // namespace vkpm
