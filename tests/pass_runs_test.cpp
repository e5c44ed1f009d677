/// Sums of passes: the same runs and the same bits however a range of passes is split, and means that are right.
#include "judge.h"
#include "map.h"
#include "render/film.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

bool operator==(PassRange a, PassRange b) { return a.begin == b.begin && a.end == b.end; }

// Joins runs from the left as the film does.
void append(std::vector<PassRange>& runs, PassRange run) {
    runs.push_back(run);
    while (runs.size() > 1 && joins(runs[runs.size() - 2], runs.back())) {
        runs[runs.size() - 2].end = runs.back().end;
        runs.pop_back();
    }
}

std::vector<PassRange> runsOf(PassRange passes) {
    std::vector<PassRange> runs;
    for (uint pass = passes.begin; pass < passes.end; pass++) append(runs, {pass, pass + 1});
    return runs;
}

TEST(PassRuns, DependOnTheRangeAlone) {
    Random random(1);
    for (int trial = 0; trial < 2000; trial++) {
        const uint begin = random.bits() % 300;
        const uint end = begin + 1 + random.bits() % 300;
        std::vector<PassRange> merged;
        for (uint first = begin; first < end;) {
            const uint last = std::min<uint>(end, first + 1 + random.bits() % 40);
            for (const PassRange run : runsOf({first, last})) append(merged, run);
            first = last;
        }
        const std::vector<PassRange> whole = runsOf({begin, end});
        ASSERT_EQ(merged.size(), whole.size()) << begin << ":" << end;
        for (std::size_t i = 0; i < whole.size(); i++) ASSERT_TRUE(merged[i] == whole[i]) << begin << ":" << end;
    }
}

TEST(PassRuns, AreFew) {
    EXPECT_EQ(runsOf({0, 16}).size(), 1u);
    EXPECT_EQ(runsOf({0, 64}).size(), 1u);
    EXPECT_EQ(runsOf({32, 64}).size(), 2u);
    for (uint n = 1; n < 3000; n += 7) EXPECT_LE(runsOf({0, n}).size(), 6u) << n; // four to the sixth is 4096
}

TEST(PassRuns, JoinOnlyTheNextSibling) {
    EXPECT_TRUE(joins({0, 1}, {1, 2}));
    EXPECT_TRUE(joins({0, 12}, {12, 16}));
    EXPECT_TRUE(joins({3u << 30, (3u << 30) + (1u << 28)}, {(3u << 30) + (1u << 28), (3u << 30) + (2u << 28)}));
    EXPECT_FALSE(joins({0, 4}, {4, 5}));
    EXPECT_FALSE(joins({1, 2}, {2, 3}));
    EXPECT_FALSE(joins({0, 4}, {8, 12}));
    EXPECT_FALSE(joins({0, 4}, {4, 6}));
}

const uvec2 size{8, 4};

std::vector<Sample> samplesOf(uint pass) {
    Random random(pass);
    std::vector<Sample> samples(size.x * size.y);
    for (Sample& sample : samples)
        for (std::size_t k = 0; k < sizeof(Sample) / 4; k++)
            reinterpret_cast<float*>(&sample)[k] = std::exp(0.3f * float(random.bits() % 100)) * (random.bits() % 2 ? 1e-3f : 1.0f);
    return samples;
}

Film filmOf(PassRange passes) {
    Film film(testGpu(), size);
    Buffer<Sample> samples(testGpu(), "samples", size.x * size.y);
    for (uint pass = passes.begin; pass < passes.end; pass++) {
        samples.upload(samplesOf(pass));
        film.begin(pass);
        film.add(samples, 0, 20); // in two tiles
        std::vector<Sample> rest = samples.download();
        rest.erase(rest.begin(), rest.begin() + 20);
        samples.upload(rest);
        film.add(samples, 20, size.x * size.y - 20);
        film.end();
    }
    return film;
}

void expectSameBits(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)), 0);
}

TEST(Film, PartsGiveTheBitsOfTheWhole) {
    const std::vector<Pixel> whole = filmOf({0, 45}).download();
    for (const std::vector<uint>& cuts : {std::vector<uint>{0, 22, 45}, {0, 1, 2, 3, 45}, {0, 16, 32, 45}, {0, 5, 6, 19, 21, 40, 45}}) {
        Film merged(testGpu(), size);
        for (std::size_t i = 1; i < cuts.size(); i++) {
            const Film part = filmOf({cuts[i - 1], cuts[i]});
            for (std::size_t run = 0; run < part.runCount(); run++) merged.restore(part.run(run), part.sums(run));
        }
        expectSameBits(merged.download(), whole);
    }
}

TEST(Film, MeansAndVariancesAreThoseOfDoublePrecision) {
    const uint passes = 300;
    const std::vector<Pixel> pixels = filmOf({0, passes}).download();
    for (std::size_t i = 0; i < pixels.size(); i++) {
        std::vector<glm::dvec3> beauty;
        glm::dvec3 direct{0}, mean{0}, squares{0};
        for (uint pass = 0; pass < passes; pass++) {
            const Sample sample = samplesOf(pass)[i];
            glm::dvec3 sum{0};
            for (const vec3& layer : sample.layers) sum += glm::dvec3(layer);
            beauty.push_back(sum);
            mean += sum / double(passes);
            direct += glm::dvec3(sample.layers[LAYER_DIRECT]) / double(passes);
        }
        for (const glm::dvec3& b : beauty) squares += (b - mean) * (b - mean);
        for (int c = 0; c < 3; c++) {
            EXPECT_NEAR(pixels[i].mean.layers[LAYER_DIRECT][c], direct[c], 1e-6 * direct[c]);
            EXPECT_NEAR(pixels[i].deviation[c], squares[c], 1e-5 * squares[c]);
        }
    }
}

TEST(Film, CountsWhatIsNotFiniteAsBlack) {
    Film film(testGpu(), {2, 1});
    Buffer<Sample> samples(testGpu(), "samples", 2);
    std::vector<Sample> values(2, Sample{});
    values[0].layers[LAYER_DIRECT] = vec3(NAN, 1, 1);
    values[1].layers[LAYER_CAUSTIC] = vec3(INFINITY);
    values[1].layers[LAYER_DIRECT] = vec3(2);
    samples.upload(values);
    film.begin(0);
    film.add(samples, 0, 2);
    film.end();
    const std::vector<Pixel> pixels = film.download();
    EXPECT_EQ(pixels[0].mean.layers[LAYER_DIRECT], vec3(0));
    EXPECT_EQ(pixels[1].mean.layers[LAYER_CAUSTIC], vec3(0));
    EXPECT_EQ(pixels[1].mean.layers[LAYER_DIRECT], vec3(2));
    EXPECT_EQ(film.nonfinite()[LAYER_DIRECT], 1u);
    EXPECT_EQ(film.nonfinite()[LAYER_CAUSTIC], 1u);
}

} // namespace
} // namespace vkpm
