/// Renders in tests: a scene and settings in, the film's layers as means over the image out.
#pragma once
#include "render/radius.h"
#include "render/renderer.h"
#include "scene_text.h"
#include "shared_layers.h"
#include <array>
#include <cmath>

namespace vkpm {

/// One Gpu per test program; the driver's setup is the slowest part of a small test.
inline Gpu& testGpu() {
    static Gpu gpu;
    return gpu;
}

struct Rendered {
    std::vector<Pixel> pixels;
    PhotonLedger global;
    PhotonLedger caustic;
    std::uint64_t nonfinite = 0;
};

inline Rendered renderPasses(const Scene& scene, Settings settings, uint passes) {
    Renderer renderer(testGpu(), scene, settings);
    for (uint pass = 0; pass < passes; pass++) renderer.renderPass(pass);
    Rendered result{renderer.film.download()};
    result.global = renderer.photons(MapKind::global);
    result.caustic = renderer.photons(MapKind::caustic);
    for (const std::uint64_t count : renderer.film.nonfinite()) result.nonfinite += count;
    return result;
}

/// The mean over the image of the mean of the three channels of a layer; LAYER_COUNT is beauty.
inline double layerMean(const std::vector<Pixel>& pixels, uint layer) {
    double sum = 0;
    for (const Pixel& pixel : pixels)
        for (uint l = 0; l < LAYER_COUNT; l++)
            if (l == layer || layer == LAYER_COUNT)
                for (int c = 0; c < 3; c++) sum += double(pixel.mean.layers[l][c]);
    return sum / (3.0 * double(pixels.size()));
}

/// Mean and standard error of a number that independent repetitions measured.
struct Estimate {
    double mean = 0;
    double error = 0;
};

inline Estimate estimate(const std::vector<double>& values) {
    const double n = double(values.size());
    Estimate result;
    for (const double value : values) result.mean += value / n;
    for (const double value : values) result.error += (value - result.mean) * (value - result.mean);
    result.error = std::sqrt(result.error / (n * (n - 1)));
    return result;
}

/// How many standard errors two estimates are apart.
inline double zScore(Estimate a, Estimate b) { return (a.mean - b.mean) / std::hypot(a.error, b.error); }

inline Scene shippedScene(const std::string& name) {
    return loadScene(std::filesystem::path(VKPM_SCENES) / (name + ".json"));
}

/// The ring's cusp from nearby: most of its caustic is out of sight, so that photons are guided.
inline Scene ringCusp() {
    Scene scene = shippedScene("ring");
    scene.view.target = {-0.3f, 0, 0.1f};
    scene.view.fieldOfView = glm::radians(6.0f);
    return scene;
}

} // namespace vkpm
