/// A hundred thousand passes of a tiny image: means and the spread between passes against sums in double precision.
#include "judge.h"
#include "map.h"
#include "render/features.h"
#include "render/film.h"
#include "render/noise.h"
#include "runs_of.h"
#include "scene/scene.h"
#include <cstdio>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

const uint passCount = 100'000;
const uvec2 size{4, 1};

// Values of a pass in red, green and blue: even, three thousand times their deviation, rare and high; always the same.
vec3 sampleOf(uint pixel, Random& random) {
    const vec3 u{random.unit(), random.unit(), random.unit()};
    if (pixel == 0) return u;
    if (pixel == 1) return 1000.0f + u;
    if (pixel == 2) return glm::exp(12.0f * u * u);
    return vec3{0.1f};
}

const char* const names[]{"even", "1000 + even", "rare and high", "constant"};

// The sums that the film has to match, of the parts of the render that deviations are about: batches of passes, and one
// for each run of passes that is less than a batch.
struct Expected {
    std::vector<PassRange> parts;
    std::vector<std::vector<glm::dvec3>> sums; // [pixel][part]
    std::size_t now = 0;                       // the part that passes go to

    Expected(std::span<const PassRange> runs, uint batch) : sums(size.x) {
        for (const PassRange run : runs)
            for (uint first = run.begin; first < run.end; first += batch)
                parts.push_back({first, std::min(run.end, first + batch)});
        for (auto& pixel : sums) pixel.resize(parts.size(), glm::dvec3(0));
    }
    glm::dvec3 mean(uint pixel) const {
        return std::accumulate(sums[pixel].begin(), sums[pixel].end(), glm::dvec3(0)) / double(passCount);
    }
    glm::dvec3 variance(uint pixel, uint batch) const {
        glm::dvec3 squares{0};
        for (std::size_t i = 0; i < parts.size(); i++) {
            const double passes = length(parts[i]);
            const glm::dvec3 off = sums[pixel][i] / passes - mean(pixel);
            squares += off * off * (passes / batch);
        }
        return squares / (double(parts.size()) - 1) / (double(passCount) / batch);
    }
};

Features directAndNoise() {
    Features features;
    askFor(1u << LAYER_DIRECT | 1u << ASK_NOISE, features);
    return features;
}

// Renders into a film and into the sums.
Film filmOf(Expected& expected) {
    const Columns columns(directAndNoise());
    Film film(testGpu(), size, columns);
    Random random(1);
    std::vector<float> samples(columns.SAMPLE_COLUMNS * size.x);
    Buffer<float> onDevice(testGpu(), "samples", samples);
    for (uint pass = 0; pass < passCount; pass++) {
        if (pass == expected.parts[expected.now].end) expected.now++;
        for (uint pixel = 0; pixel < size.x; pixel++) {
            const vec3 sample = sampleOf(pixel, random);
            expected.sums[pixel][expected.now] += glm::dvec3(sample);
            for (uint c = 0; c < 3; c++)
                samples[(columns.COLUMN_DIRECT + c) * size.x + pixel] = sample[static_cast<int>(c)];
        }
        onDevice.upload(samples);
        Recording recording(testGpu());
        film.begin(recording, pass);
        film.add(recording, onDevice, size.x, 0, size.x);
        recording.submit();
        film.end();
    }
    return film;
}

// The variance of the mean that the film has, of a pixel.
glm::dvec3 varianceIn(const Film& film, const std::vector<std::vector<PixelSum>>& sums, uint pixel, uint batch) {
    const std::vector<PassRange> runs = film.ranges();
    SpreadSum spread;
    for (std::size_t i = 0; i < runs.size(); i++)
        spread.add(runs[i], batch,
                   glm::dvec3(sums[i][pixel].sum.layers[LAYER_DIRECT]) + glm::dvec3(sums[i][pixel].rest),
                   glm::dvec3(sums[i][pixel].fine), glm::dvec3(sums[i][pixel].coarse));
    return spread.variance(batchesOf(runs, batch));
}

TEST(Sums, OfAHundredThousandPasses) {
    const std::vector<PassRange> runs = runsOf({0, passCount});
    const uint batch = greatestBatch(runs);
    Expected expected(runs, batch);
    const Film film = filmOf(expected);
    std::vector<std::vector<PixelSum>> sums;
    for (std::size_t i = 0; i < runs.size(); i++) sums.push_back(film.sums(i));
    const std::vector<Pixel> pixels = film.download();

    for (uint pixel = 0; pixel < size.x; pixel++) {
        const glm::dvec3 mean = expected.mean(pixel), variance = expected.variance(pixel, batch),
                         found = varianceIn(film, sums, pixel, batch);
        double meanOff = 0, varianceOff = 0;
        for (int c = 0; c < 3; c++) {
            meanOff = std::max(meanOff, std::abs(double{pixels[pixel].mean.layers[LAYER_DIRECT][c]} / mean[c] - 1));
            if (variance[c] > 0) varianceOff = std::max(varianceOff, std::abs(found[c] / variance[c] - 1));
        }
        std::printf("| %s | %.1e | %.1e |\n", names[pixel], meanOff, varianceOff);
        EXPECT_LE(meanOff, 1e-6) << names[pixel];
        EXPECT_LE(varianceOff, 1e-6) << names[pixel];
    }
}

} // namespace
} // namespace vkpm
