/// Each layer of the photon integrator against the path tracer, which counts the same paths.
#include "draw.h"
#include "render_support.h"
#include "scene/luminance.h"
#include "shared_layers.h"
#include <gtest/gtest.h>
#include <map>

namespace vkpm {
namespace {

const std::map<uint, const char*> layerNames{{LAYER_EMISSION, "emission"}, {LAYER_DIRECT, "direct"},
                                             {LAYER_SPECULAR, "specular"}, {LAYER_CAUSTIC, "caustic"},
                                             {LAYER_INDIRECT, "indirect"}, {LAYER_COUNT, "beauty"}};

const uint repetitions = 8;

/// Image means of layers over independent seeds.
std::map<uint, Estimate> renderSeeds(const Scene& scene, Settings settings, uint passes) {
    std::map<uint, std::vector<double>> values;
    std::map<uint, Estimate> result;
    for (uint seed = 0; seed < repetitions; seed++) {
        settings.seed = 100 + seed;
        const Rendered image = renderPasses(scene, settings, passes);
        EXPECT_EQ(image.nonfinite, 0u);
        for (const auto& [layer, _] : layerNames) values[layer].push_back(layerMean(image.pixels, layer));
    }
    for (const auto& [layer, list] : values) result[layer] = estimate(list);
    return result;
}

// Mean of (x - ref)^2 / (ref^2 + 0.01) over pixels and channels of a layer.
double relMse(const std::vector<Pixel>& image, const std::vector<Pixel>& reference, uint layer) {
    double sum = 0;
    for (std::size_t i = 0; i < image.size(); i++)
        for (int c = 0; c < 3; c++) {
            const double truth = reference[i].mean.layers[layer][c];
            const double error = image[i].mean.layers[layer][c] - truth;
            sum += error * error / (truth * truth + 0.01);
        }
    return sum / (3.0 * double(image.size()));
}

struct Case {
    const char* scene;
    float radius;        // small enough that the bias of the gathers is below the noise
    float causticRadius; //
    uint pathPasses;
    uint photonPasses;
    double bias; // of an image mean that the radii may cause, relative
    double allowed = 0.04,
           allowedSpecular = 0.3; // of means that noise may hide, of diffuse light and of what mirrors and glass bring
};

// The bias of discs at the edges of walls: a disc of radius r loses 0.21 r per length of edge, which for the walls of
// the box (side 2) is 0.42 r, 0.25 % of the indirect light at the radii used here; `bias` is that much. The rest is
// noise: 4 sigma.
void expectAgreement(const Case& c) {
    const Scene scene = shippedScene(c.scene);
    Settings settings = scene.settings;
    settings.size = {48, 48};
    settings.photons = settings.causticPhotons = 30'000;
    settings.radius = c.radius;
    settings.causticRadius = c.causticRadius;
    const auto photon = renderSeeds(scene, settings, c.photonPasses);
    settings.integrator = INTEGRATOR_PATH;
    const auto path = renderSeeds(scene, settings, c.pathPasses);

    for (const auto& [layer, name] : layerNames) {
        const Estimate a = photon.at(layer);
        const Estimate b = path.at(layer);
        const double allowed = 4 * std::hypot(a.error, b.error) + c.bias * b.mean;
        std::printf("%-12s %-9s photon %.6f +- %.6f  path %.6f +- %.6f  z %+.2f\n", c.scene, name, a.mean, a.error,
                    b.mean, b.error, zScore(a, b));
        EXPECT_NEAR(a.mean, b.mean, allowed) << c.scene << " " << name;
        // light_tracing_test is sharper on caustics, of which the path tracer finds few.
        const double sharp = layer == LAYER_CAUSTIC || layer == LAYER_SPECULAR ? c.allowedSpecular : c.allowed;
        EXPECT_LE(allowed, sharp * b.mean) << c.scene << " " << name << ": the noise is too great to see an error";
    }
}

TEST(Layers, BoxAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(0);
    expectAgreement({"box", 0.006f, 0.01f, 64, 16, 0.003});
}
TEST(Layers, DiffuseBoxAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(1);
    expectAgreement({"diffuse_box", 0.006f, 0.01f, 64, 16, 0.003});
}
TEST(Layers, RingAgreesWithThePathTracer) {
    SKIP_UNLESS_DRAWN(0);
    expectAgreement({"ring", 0.015f, 0.015f, 64, 16, 0.003});
}
TEST(Layers, PoolAgreesWithThePathTracer) {
    if (!isThorough()) GTEST_SKIP() << "takes as long as the other scenes together: tools/test --all";
    SKIP_UNLESS_DRAWN(1);
    expectAgreement({"pool", 0.015f, 0.015f, 64, 16, 0.003, 0.12, 2});
}

// At equal passes the photon integrator's caustic and indirect light are nearer to the truth than the path tracer's.
TEST(Layers, BoxIsNearerToTheTruthAtEqualPasses) {
    const Scene scene = shippedScene("box");
    Settings settings = scene.settings;
    settings.size = {48, 48};
    settings.photons = settings.causticPhotons = 50'000;
    const std::vector<Pixel> photon = renderPasses(scene, settings, 8).pixels;
    settings.integrator = INTEGRATOR_PATH;
    const std::vector<Pixel> path = renderPasses(scene, settings, 8).pixels;
    settings.seed = 1000;
    const std::vector<Pixel> truth = renderPasses(scene, settings, 512).pixels;
    for (const auto& [layer, factor] : {std::pair{LAYER_DIRECT, 1.05}, {LAYER_CAUSTIC, 0.2}, {LAYER_INDIRECT, 1.0}}) {
        const double ours = relMse(photon, truth, layer);
        const double theirs = relMse(path, truth, layer);
        std::printf("relMSE of %s after 8 passes: photon %.5f, path %.5f\n", layerNames.at(layer), ours, theirs);
        EXPECT_LT(ours, factor * theirs) << layerNames.at(layer);
    }
}

/// The mean over pixels of the variance of a layer's luminance between renders.
double varianceOf(const std::vector<Rendered>& renders, uint layer) {
    const std::size_t pixels = renders.front().pixels.size();
    double sum = 0;
    for (std::size_t i = 0; i < pixels; i++) {
        std::vector<double> values;
        for (const Rendered& render : renders) values.push_back(luminance(render.pixels[i].mean.layers[layer]));
        sum += std::pow(estimate(values).error, 2) * double(values.size());
    }
    return sum / double(pixels);
}

// Below a sky and a lamp, with a ball of glass and one of plastic: further paths of a pixel have the same means, and
// take noise of light samples and of what glass shows; photons and gather rays know nothing of them.
TEST(Layers, FurtherPathsOfAPixelTakeNoiseAlone) {
    const auto ball = [](double x, const char* material) {
        return nlohmann::json{{"type", "sphere"}, {"center", {x, 0.5, 0}}, {"radius", 0.5}, {"material", material}};
    };
    Scene scene = loadJson(
        {{"camera", {{"origin", {0, 2, 5}}, {"target", {0, 0.5, 0}}, {"up", {0, 1, 0}}, {"fieldOfView", 35}}},
         {"film", {{"size", {24, 18}}}},
         {"environment", {{"radiance", {0.5, 0.6, 0.8}}}},
         {"materials",
          {{"grey", {{"type", "diffuse"}, {"albedo", 0.5}}},
           {"glass", {{"type", "glass"}, {"ior", 1.5}}},
           {"plastic", {{"type", "plastic"}, {"albedo", {0.6, 0.2, 0.1}}, {"roughness", 0.4}}}}},
         {"shapes",
          {{{"type", "rectangle"}, {"corner", {-4, 0, 4}}, {"edges", {{8, 0, 0}, {0, 0, -8}}}, {"material", "grey"}},
           {{"type", "sphere"}, {"center", {-1, 3, 1}}, {"radius", 0.2}, {"emission", 60}},
           ball(-0.7, "glass"),
           ball(0.7, "plastic")}}});
    std::map<uint, std::vector<Rendered>> renders;
    std::map<uint, std::map<uint, Estimate>> means;
    for (const uint paths : {1u, 5u}) {
        std::map<uint, std::vector<double>> values;
        for (uint seed = 0; seed < repetitions; seed++) {
            Settings settings = scene.settings;
            settings.pixelSamples = paths;
            settings.seed = seed;
            settings.photons = settings.causticPhotons = 2000;
            settings.radius = settings.causticRadius = 0.2f;
            renders[paths].push_back(renderPasses(scene, settings, 8));
            for (const auto& [layer, _] : layerNames)
                values[layer].push_back(layerMean(renders[paths].back().pixels, layer));
        }
        for (const auto& [layer, list] : values) means[paths][layer] = estimate(list);
    }
    for (const auto& [layer, name] : layerNames) {
        const Estimate one = means[1][layer], five = means[5][layer];
        std::printf("%-9s %.6f +- %.6f  five paths %.6f +- %.6f\n", name, one.mean, one.error, five.mean, five.error);
        EXPECT_NEAR(five.mean, one.mean, 4 * std::hypot(one.error, five.error) + 1e-6 * one.mean) << name;
    }
    for (const auto& [layer, part] : {std::pair{LAYER_DIRECT, 0.4}, {LAYER_SPECULAR, 0.5}}) {
        const double one = varianceOf(renders[1], layer), five = varianceOf(renders[5], layer);
        std::printf("variance of %s: %.3g, five paths %.3g\n", layerNames.at(layer), one, five);
        EXPECT_LT(five, part * one) << layerNames.at(layer);
    }
    for (std::size_t i = 0; i < renders[1][0].pixels.size(); i++) {
        const float one = renders[1][0].pixels[i].mean.layers[LAYER_CAUSTIC].x;
        EXPECT_NEAR(renders[5][0].pixels[i].mean.layers[LAYER_CAUSTIC].x, one, 1e-5f * one);
    }
}

/// A lamp seen in a sheet of water from straight above, or in a pane of glass at 45 degrees, over black; `lamp` is its
/// kind and place.
nlohmann::json glint(const nlohmann::json& lamp, bool isPane) {
    nlohmann::json scene{
        {"camera", {{"origin", {0.1, 2, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, -1}}, {"fieldOfView", 1}}},
        {"film", {{"size", {8, 8}}}},
        {"materials", {{"water", {{"type", "glass"}, {"ior", 1.5}}}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-1, 0, 1}}, {"edges", {{2, 0, 0}, {0, 0, -2}}}, {"material", "water"}}}}};
    if (isPane) {
        scene["camera"]["origin"] = {1.5, 1.5, 0};
        scene["shapes"].push_back({{"type", "rectangle"},
                                   {"corner", {-1, -0.1, -1}},
                                   {"edges", {{2, 0, 0}, {0, 0, 2}}},
                                   {"material", "water"}});
    }
    scene["shapes"].push_back(lamp);
    return scene;
}

/// The mean of the layer `specular` of such a scene, and its noise after 16 passes.
Estimate glintEstimate(const nlohmann::json& lamp, bool isPane, uint integrator) {
    const Scene scene = loadJson(glint(lamp, isPane));
    Settings settings = scene.settings;
    settings.integrator = integrator;
    settings.photons = settings.causticPhotons = 100;
    settings.pixelSamples = 1;
    const std::vector<Pixel> pixels = renderPasses(scene, settings, 16).pixels;
    double squares = 0;
    for (const Pixel& pixel : pixels) squares += std::pow(double(pixel.noise.x), 2) / double(pixels.size());
    return {layerMean(pixels, LAYER_SPECULAR), std::sqrt(squares)};
}

// Glass reflects a twenty-fifth of what falls upon it at right angles. A pixel that shows a lamp so is right in the
// mean, and its samples differ by no more than two of equal weight, of which one is black.
TEST(Glints, AreAsBrightAsTheyShouldBeAndNoSpecks) {
    const nlohmann::json lamps[]{
        {{"type", "rectangle"}, {"corner", {-0.2, 2, -0.1}}, {"edges", {{0.2, 0, 0}, {0, 0, 0.2}}}, {"emission", 100}},
        {{"type", "sphere"}, {"center", {-0.1, 2, 0}}, {"radius", 0.1}, {"emission", 100}}};
    for (const nlohmann::json& lamp : lamps)
        for (const auto integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH}) {
            const double right = 0.04 * 100;
            const Estimate found = glintEstimate(lamp, false, integrator);
            std::printf("%s: %.3f for %.3f, noise %.3f\n", lamp["type"].get<std::string>().c_str(), found.mean, right,
                        found.error);
            EXPECT_NEAR(found.mean, right, 4 * right / std::sqrt(16.0 * 64));
            EXPECT_LT(found.error, 1.3 * right / std::sqrt(16.0)); // by chance alone it would be 4.9 times this
        }
}

// The same by a pane, which reflects on both sides, r of what falls upon each: in all 2 r / (1 + r). A sample is 2 r of
// the lamp by the upper side, one time of two, or 4 r (1 - r) by the lower one, one time of four, or nearly always
// black.
TEST(Glints, WithinGlassAreNoSpecks) {
    const nlohmann::json lamp{{"type", "sphere"}, {"center", {-1.55, 1.5, 0}}, {"radius", 0.2}, {"emission", 100}};
    const double i = std::sqrt(0.5), t = std::sqrt(1 - 0.5 / 2.25);
    const double r = (std::pow((i - 1.5 * t) / (i + 1.5 * t), 2) + std::pow((1.5 * i - t) / (1.5 * i + t), 2)) / 2;
    const double right = 100 * 2 * r / (1 + r);
    const double square = 1e4 * (std::pow(2 * r, 2) / 2 + std::pow(4 * r * (1 - r), 2) / 4);
    const double deviation = std::sqrt(square - right * right);
    for (const auto integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH}) {
        const Estimate found = glintEstimate(lamp, true, integrator);
        std::printf("%.3f for %.3f, noise %.3f for %.3f\n", found.mean, right, found.error,
                    deviation / std::sqrt(16.0));
        EXPECT_NEAR(found.mean, right, 4 * deviation / std::sqrt(16.0 * 64));
        EXPECT_LT(found.error,
                  1.3 * deviation / std::sqrt(16.0)); // by chance at the lower side it would be 4 times this
    }
}

} // namespace
} // namespace vkpm
