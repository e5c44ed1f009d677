/// How error falls with passes: as 1 / sqrt(n) where light is path or light traced, as the cube root where it is
/// gathered in shrinking discs (Knaus & Zwicker 2011), and not below the bias of discs that stay.
#include "draw.h"
#include "lamp_in_mirror.h"
#include "output/exr.h"
#include "render_support.h"
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

Values layerOf(const std::vector<Pixel>& pixels, uint layer) {
    Values values;
    for (const Pixel& pixel : pixels)
        for (int c = 0; c < 3; c++) values.push_back(pixel.mean.layers[layer][c]);
    return values;
}

double rms(const Values& a, const Values& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / double(a.size()));
}

struct Curve {
    std::vector<double> passes;
    std::vector<double> errors; // root of the mean square over pixels and seeds

    /// Of the least squares line through the logarithms, from `first` passes on.
    double slope(double first) const {
        double n = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (std::size_t i = 0; i < passes.size(); i++) {
            if (passes[i] < first) continue;
            const double u = std::log(passes[i]), v = std::log(errors[i]);
            n++, x += u, y += v, xx += u * u, xy += u * v;
        }
        return (n * xy - x * y) / (n * xx - x * x);
    }
};

/// Errors of a layer after 1, 2, 4 ... `most` passes.
Curve converge(const char* name, const Scene& scene, Settings settings, uint layer, const Values& truth, uint most,
               uint seeds) {
    Curve curve;
    for (uint seed = 0; seed < seeds; seed++) {
        settings.seed = 10 + seed;
        Renderer renderer(testGpu(), scene, settings);
        for (uint pass = 0, next = 1, k = 0; pass < most; pass++) {
            renderer.renderPass(pass);
            if (pass + 1 < next) continue;
            if (seed == 0) curve.passes.push_back(next), curve.errors.push_back(0);
            const double error = rms(layerOf(renderer.film.download(), layer), truth);
            curve.errors[k++] += error * error / seeds;
            next *= 2;
        }
    }
    std::printf("%-34s", name);
    for (double& error : curve.errors) std::printf(" %.2e", error = std::sqrt(error));
    std::printf("  slope %+.2f\n", curve.slope(8));
    return curve;
}

// Independent samples give -1/2, Sobol points more where light is smooth.
void expectPathTraced(double slope) {
    EXPECT_LE(slope, -0.45);
    EXPECT_GE(slope, -0.75);
}

// ---- A closed form: a lamp seen by a floor in a mirror -----------------------------------------

TEST(Convergence, OfALampInAMirror) {
    SKIP_UNLESS_DRAWN(1);
    const Scene scene = loadJson(lampInMirror());
    Settings settings = scene.settings;
    settings.photons = 0;
    settings.causticPhotons = 10'000;
    settings.causticRadius = 0.3f;
    const Values truth = floorTruth(scene, settings.size);
    const double mean = std::accumulate(truth.begin(), truth.end(), 0.0) / double(truth.size());

    const Curve shrinking = converge("mirror, shrinking discs", scene, settings, LAYER_CAUSTIC, truth, 256, 3);
    EXPECT_NEAR(shrinking.slope(8), -1.0 / 3, 0.08);
    EXPECT_LT(shrinking.errors.back(), 0.02 * mean);

    settings.alpha = 1;
    const Curve fixed = converge("mirror, fixed discs", scene, settings, LAYER_CAUSTIC, truth, 256, 3);
    EXPECT_NEAR(fixed.slope(64), 0, 0.12);
    EXPECT_GT(fixed.errors.back(), 1.5 * shrinking.errors.back());

    settings.integrator = INTEGRATOR_PATH;
    const Curve path = converge("mirror, path traced", scene, settings, LAYER_CAUSTIC, truth, 256, 3);
    expectPathTraced(path.slope(8));

    settings.integrator = INTEGRATOR_LIGHT;
    const Curve light = converge("mirror, light traced", scene, settings, LAYER_CAUSTIC, truth, 256, 3);
    EXPECT_NEAR(light.slope(8), -0.5, 0.05); // the points of passes are independent
    EXPECT_LT(light.errors.back(), 0.03 * mean);
    settings.causticPhotons = 100'000;
    EXPECT_NEAR(layerMean(renderPasses(scene, settings, 64).pixels, LAYER_CAUSTIC), mean, 0.006 * mean);
}

// ---- The box, against a long render of it in tests/data ------------------------------------------
// vkpm --scene scenes/box.json --size 48x48 --passes 1024 --photons 1e5 --caustic-photons 1e5 --seed 4711

TEST(Convergence, OfTheBox) {
    SKIP_UNLESS_DRAWN(0);
    const Image reference = readExr(std::filesystem::path(VKPM_TEST_DATA) / "box_reference.exr");
    const Scene scene = shippedScene("box");
    Settings settings = scene.settings;
    settings.size = reference.size;
    settings.photons = settings.causticPhotons = 10'000;
    const Values caustic = referenceLayer(reference, "caustic");
    const Values direct = referenceLayer(reference, "direct");
    const Values indirect = referenceLayer(reference, "indirect");

    const Curve gathered = converge("box, caustic", scene, settings, LAYER_CAUSTIC, caustic, 128, 2);
    EXPECT_NEAR(gathered.slope(4), -1.0 / 3, 0.1);
    const Curve final = converge("box, indirect", scene, settings, LAYER_INDIRECT, indirect, 128, 1);
    EXPECT_GE(final.slope(4), -0.6); // path traced to the gather, gathered there
    EXPECT_LE(final.slope(4), -0.3);
    const Curve traced = converge("box, direct", scene, settings, LAYER_DIRECT, direct, 128, 1);
    expectPathTraced(traced.slope(4));

    settings.alpha = 1;
    settings.causticRadius = 0.1f;
    const Curve fixed = converge("box, caustic in fixed discs", scene, settings, LAYER_CAUSTIC, caustic, 128, 2);
    EXPECT_NEAR(fixed.slope(16), 0, 0.1);
    EXPECT_GT(fixed.errors.back(), 2 * gathered.errors.back());
}

} // namespace
} // namespace vkpm
