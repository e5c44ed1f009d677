/// Labels of events in a room with all of them: each layer by photons is that of the path tracer, and which label gloss
/// has changes no beauty.
#include "draw.h"
#include "render_support.h"
#include "scene_text.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

const char* const layerNames[]{"emission", "direct", "specular", "caustic", "indirect", "beauty"};

Scene room(float wideAlpha = WIDE_ALPHA) {
    return loadScene(std::filesystem::path{VKPM_TEST_DATA} / "kinds.json", wideAlpha);
}

/// Means of layers over the picture, the last of beauty, over independent seeds.
std::vector<Estimate> means(const Scene& scene, uint integrator, uint passes) {
    Settings settings = scene.settings;
    settings.integrator = integrator;
    std::vector<std::vector<double>> values(LAYER_COUNT + 1);
    for (settings.seed = 1; settings.seed <= 8; settings.seed++) {
        const Rendered image = renderPasses(scene, settings, passes);
        EXPECT_EQ(image.nonfinite, 0u);
        for (uint layer = 0; layer <= LAYER_COUNT; layer++) values[layer].push_back(layerMean(image.pixels, layer));
    }
    std::vector<Estimate> result;
    for (const std::vector<double>& list : values) result.push_back(estimate(list));
    return result;
}

const std::vector<Estimate>& byPhotons() {
    static const std::vector<Estimate> known = means(room(), INTEGRATOR_PHOTON, 24);
    return known;
}

/// `noise`, of the mean: what may hide an error. `bias`: what discs may lose beyond edges.
void expectSame(Estimate a, Estimate b, double noise, double bias, const std::string& what) {
    const double allowed = 4 * std::hypot(a.error, b.error);
    std::printf("%-9s %.6f +- %.6f, %.6f +- %.6f, z %+.2f\n", what.c_str(), a.mean, a.error, b.mean, b.error,
                zScore(a, b));
    EXPECT_NEAR(a.mean, b.mean, allowed + bias * b.mean) << what;
    EXPECT_LE(allowed, noise * b.mean) << what << ": the noise is too great to see an error";
}

TEST(Labels, AreThoseOfThePathTracer) {
    SKIP_UNLESS_DRAWN(0);
    const std::vector<Estimate>& photon = byPhotons();
    const std::vector<Estimate> path = means(room(), INTEGRATOR_PATH, 128);
    const std::vector<Estimate> direct = means(room(), INTEGRATOR_DIRECT, 16);
    const double noise[]{0.01, 0.01, 0.05, 0.12, 0.04, 0.02};
    for (uint layer = 0; layer <= LAYER_COUNT; layer++)
        // A disc of radius r loses .21 r for a length of edge.
        expectSame(photon[layer], path[layer], noise[layer],
                   layer == LAYER_INDIRECT || layer == LAYER_CAUSTIC ? 0.012 : 0.003, layerNames[layer]);
    const Estimate light = means(room(), INTEGRATOR_LIGHT, 32)[LAYER_CAUSTIC];
    expectSame(light, path[LAYER_CAUSTIC], 0.12, 0.003, "caustics by light tracing");
    expectSame(direct[LAYER_DIRECT], path[LAYER_DIRECT], 0.02, 0, "direct light alone");
}

TEST(Labels, MoveNoBeauty) {
    SKIP_UNLESS_DRAWN(1);
    for (const float wideAlpha : {0.1f, 0.5f})
        expectSame(means(room(wideAlpha), INTEGRATOR_PHOTON, 24).back(), byPhotons().back(), 0.02, 0.003,
                   std::to_string(wideAlpha));
}

// Rough metal and plastic in the sun behind a pane: no ray that they reflect finds the sun beyond glass but by luck,
// and what does is thousands of times too bright. Photons show it, as light tracing does.
TEST(Labels, RoughSurfacesShowCausticsOfASun) {
    const Scene scene = loadText(R"({
        "camera": {"origin": [0, 0.8, 1.5], "target": [0, 0.1, 0], "up": [0, 1, 0], "fieldOfView": 50},
        "film": {"size": [24, 18]},
        "materials": {"metal": {"type": "metal", "reflectance": [0.9, 0.7, 0.4], "roughness": 0.6},
                      "plastic": {"type": "plastic", "albedo": [0.1, 0.2, 0.3], "roughness": 0.6},
                      "pane": {"type": "glass", "ior": 1.5, "thin": true}},
        "lights": [{"type": "sun", "direction": [-1, 2, -2], "irradiance": 3}],
        "shapes": [{"type": "rectangle", "corner": [-2, 0, 2], "edges": [[2, 0, 0], [0, 0, -4]], "material": "metal"},
                   {"type": "rectangle", "corner": [0, 0, 2], "edges": [[2, 0, 0], [0, 0, -4]], "material": "plastic"},
                   {"type": "rectangle", "corner": [-4, 1, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "pane"}]})");
    expectSame(means(scene, INTEGRATOR_PHOTON, 4)[LAYER_CAUSTIC], means(scene, INTEGRATOR_LIGHT, 8)[LAYER_CAUSTIC],
               0.04, 0.003, "caustics");
}

// Frosted glass likewise: from outside a ball shows what it reflects, as light tracing has it. What it lets through
// is seen from within alone, where a ray of the path tracer runs into the sun only if that is large.
TEST(Labels, FrostedGlassShowsCausticsOfASun) {
    const auto ball = [](double angle) {
        return loadText(fmt::format(R"({{
            "camera": {{"origin": [0, 0.2, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfView": 20}},
            "film": {{"size": [16, 12]}},
            "materials": {{"frosted": {{"type": "glass", "ior": 1.5, "roughness": 0.6}},
                          "pane": {{"type": "glass", "ior": 1.5, "thin": true}}}},
            "lights": [{{"type": "sun", "direction": [-1, 2, -2], "irradiance": 3, "angle": {}}}],
            "shapes": [{{"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "material": "frosted"}},
                       {{"type": "rectangle", "corner": [-1.3, 1, -0.1], "edges": [[1.6, 0, 0], [0, 0, -1.8]],
                        "material": "pane"}}]}})",
                                    angle));
    };
    expectSame(means(ball(0.5), INTEGRATOR_PHOTON, 12)[LAYER_CAUSTIC],
               means(ball(0.5), INTEGRATOR_LIGHT, 4)[LAYER_CAUSTIC], 0.07, 0.003, "reflected caustics");
    expectSame(means(ball(20), INTEGRATOR_PHOTON, 12)[LAYER_INDIRECT],
               means(ball(20), INTEGRATOR_PATH, 1000)[LAYER_INDIRECT], 0.14, 0.003, "caustics from within");
}

} // namespace
} // namespace vkpm
