/// Sums of passes: the same runs and the same bits however a range of passes is split, and means that are right.
#include "judge.h"
#include "map.h"
#include "render/error_estimate.h"
#include "render/features.h"
#include "render/film.h"
#include "render/noise.h"
#include "runs_of.h"
#include "scene/scene.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

bool operator==(PassRange a, PassRange b) { return a.begin == b.begin && a.end == b.end; }

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

const Columns columns;

// [column][pixel]
std::vector<float> samplesOf(uint pass) {
    Random random(pass);
    std::vector<float> samples(columns.SAMPLE_COLUMNS * size.x * size.y);
    for (float& value : samples)
        value = std::exp(0.3f * float(random.bits() % 100)) * (random.bits() % 2 ? 1e-3f : 1.0f);
    return samples;
}

vec3 layerAt(const std::vector<float>& samples, uint layer, std::size_t pixel) {
    const std::size_t stride = samples.size() / columns.SAMPLE_COLUMNS;
    const auto at = [&](uint c) { return samples[(3 * layer + c) * stride + pixel]; };
    return {at(0), at(1), at(2)};
}

// Takes samples of a pass's pixels from `first` on into a film.
void take(Film& film, Recording& recording, const std::vector<float>& samples, uint first, uint count) {
    const Buffer<float> onDevice(testGpu(), "samples", samples);
    film.add(recording, onDevice, count, first, count);
    recording.submit();
}

Film filmOf(PassRange passes, uint blockPixels = 1u << 22) {
    Film film(testGpu(), size, {}, blockPixels);
    const uint pixels = size.x * size.y;
    for (uint pass = passes.begin; pass < passes.end; pass++) {
        const std::vector<float> all = samplesOf(pass);
        Recording recording(testGpu());
        film.begin(recording, pass);
        for (const auto& [first, end] : {std::pair{0u, 20u}, {20u, pixels}}) { // in two tiles
            std::vector<float> tile;
            for (uint column = 0; column < columns.SAMPLE_COLUMNS; column++)
                tile.insert(tile.end(), all.begin() + column * pixels + first, all.begin() + column * pixels + end);
            take(film, recording, tile, first, end - first);
        }
        film.end();
    }
    return film;
}

void expectSameBits(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)), 0);
}

// Blocks of a row, of some rows, the last one shorter, and of less than a row, that is a row: tiles and reads cross
// their borders.
TEST(Film, BlocksGiveTheBitsOfTheWhole) {
    const PassRange passes{3, 25};
    const Film whole = filmOf(passes);
    for (const uint blockPixels : {1u, size.x, 2 * size.x + 1, 3 * size.x}) {
        const Film blocks = filmOf(passes, blockPixels);
        expectSameBits(blocks.download(), whole.download());
        Film restored(testGpu(), size, {}, blockPixels);
        for (std::size_t i = 0; i < whole.runCount(); i++) restored.restore(whole.run(i), whole.sums(i));
        expectSameBits(restored.download(), whole.download());
    }
}

TEST(Film, PartsGiveTheBitsOfTheWhole) {
    const std::vector<Pixel> whole = filmOf({0, 45}).download();
    for (const std::vector<uint>& cuts :
         {std::vector<uint>{0, 22, 45}, {0, 1, 2, 3, 45}, {0, 16, 32, 45}, {0, 5, 6, 19, 21, 40, 45}}) {
        Film merged(testGpu(), size);
        for (std::size_t i = 1; i < cuts.size(); i++) {
            const Film part = filmOf({cuts[i - 1], cuts[i]});
            for (std::size_t run = 0; run < part.runCount(); run++) merged.restore(part.run(run), part.sums(run));
        }
        expectSameBits(merged.download(), whole);
    }
}

// Where the host does not see the device's memory each copy is a wait, which takes a GPU half a millisecond: a film of
// 64 rows comes and goes in two.
TEST(Film, IsCopiedInFewPieces) {
    setenv("VKPM_STAGING", "1", 1);
    Gpu gpu;
    unsetenv("VKPM_STAGING");
    const uvec2 pixels{5, 64};
    Random random(1);
    std::vector<PixelSum> sums(pixels.x * pixels.y);
    for (PixelSum& sum : sums)
        for (uint i = 0; i < PIXEL_FLOATS; i++) reinterpret_cast<float*>(&sum)[i] = random.unit();
    Film film(gpu, pixels);
    const std::uint64_t before = gpu.times["staging"].dispatches;
    film.restore({0, 1}, sums);
    EXPECT_EQ(gpu.times["staging"].dispatches - before, 2u);
    const std::vector<PixelSum> back = film.sums(0);
    EXPECT_EQ(gpu.times["staging"].dispatches - before, 3u);
    ASSERT_EQ(back.size(), sums.size());
    EXPECT_EQ(std::memcmp(back.data(), sums.data(), sums.size() * sizeof(PixelSum)), 0);
}

TEST(PassRuns, BatchesOfTwoSizesHaveDeviationsInEveryRun) {
    Random random(2);
    for (int trial = 0; trial < 3000; trial++) {
        const uint begin = trial % 2 ? 0 : random.bits() % 500;
        const PassRange passes{begin, begin + 1 + random.bits() % 2000};
        const std::vector<PassRange> runs = runsOf(passes);
        const uint greatest = greatestBatch(runs);
        for (const PassRange run : runs) {
            const uint coarse = coarseBatch(run);
            for (const uint batch : {greatest, greatest / 4})
                ASSERT_TRUE(batch == 0 || length(run) <= batch || coarse == batch || coarse == 4 * batch)
                    << passes.begin << ":" << passes.end;
        }
        EXPECT_TRUE(begin > 0 || length(passes) < 8 || batchesOf(runs, greatest / 4).count >= 8u) << length(passes);
        EXPECT_DOUBLE_EQ(batchesOf(runs, greatest).weight, double(length(passes)) / greatest);
    }
}

// The variance of the mean by batches as defined: whole ones of a size, and a part of one for each run that is less.
TEST(Film, SpreadIsTheVarianceOfTheMeanByBatches) {
    for (const PassRange passes : {PassRange{0, 16}, {0, 3}, {0, 64}, {0, 100}, {3, 90}, {20, 21}, {0, 37}}) {
        const std::vector<PassRange> runs = runsOf(passes);
        const Film film = filmOf(passes);
        std::vector<std::vector<PixelSum>> sums;
        for (std::size_t i = 0; i < runs.size(); i++) sums.push_back(film.sums(i));
        for (const uint batch : {greatestBatch(runs), greatestBatch(runs) / 4}) {
            if (batch == 0) continue;
            std::vector<PassRange> parts;
            for (const PassRange run : runs)
                for (uint first = run.begin; first < run.end; first += batch)
                    parts.push_back({first, std::min(run.end, first + batch)});
            const Batches batches = batchesOf(runs, batch);
            ASSERT_EQ(parts.size(), batches.count);
            for (std::size_t i = 0; i < 5; i++) {
                SpreadSum spread;
                for (std::size_t k = 0; k < runs.size(); k++) {
                    glm::dvec3 beauty(sums[k][i].rest);
                    for (const vec3& layer : sums[k][i].sum.layers) beauty += glm::dvec3(layer);
                    spread.add(runs[k], batch, beauty, glm::dvec3(sums[k][i].fine), glm::dvec3(sums[k][i].coarse));
                }
                std::vector<glm::dvec3> means;
                glm::dvec3 mean{0};
                for (const PassRange part : parts) {
                    glm::dvec3 sum{0};
                    for (uint pass = part.begin; pass < part.end; pass++) {
                        const std::vector<float> samples = samplesOf(pass);
                        for (uint layer = 0; layer < LAYER_COUNT; layer++)
                            sum += glm::dvec3(layerAt(samples, layer, i));
                    }
                    mean += sum / double(length(passes));
                    means.push_back(sum / double(length(part)));
                }
                glm::dvec3 squares{0};
                for (std::size_t k = 0; k < parts.size(); k++)
                    squares += (means[k] - mean) * (means[k] - mean) * (double(length(parts[k])) / batch);
                const double weight = double(length(passes)) / batch;
                for (int c = 0; c < 3; c++) {
                    const double variance = parts.size() < 2 ? 0 : squares[c] / (double(parts.size()) - 1) / weight;
                    EXPECT_NEAR(spread.variance(batches)[c], variance, 1e-6 * variance)
                        << passes.begin << ":" << passes.end << " by " << batch;
                }
            }
        }
    }
}

TEST(Film, MeansAreThoseOfDoublePrecision) {
    const std::vector<Pixel> pixels = filmOf({0, 100}).download();
    for (std::size_t i = 0; i < pixels.size(); i++) {
        glm::dvec3 direct{0};
        for (uint pass = 0; pass < 100; pass++) direct += glm::dvec3(layerAt(samplesOf(pass), LAYER_DIRECT, i)) / 100.0;
        for (int c = 0; c < 3; c++) EXPECT_NEAR(pixels[i].mean.layers[LAYER_DIRECT][c], direct[c], 1e-6 * direct[c]);
    }
}

// Intervals of independent samples have the truth in them as often as they say, and those of samples that complement
// each other, too.
TEST(Noise, IntervalsHoldTheTruthNineTimesOfTen) {
    const uvec2 area{64, 64};
    Features few;
    askFor(1u << LAYER_DIRECT | 1u << ASK_NOISE, few);
    const Columns own(few);
    const Film first(testGpu(), area, few); // its kernels are compiled once
    for (const bool stratified : {false, true})
        for (const uint passes : {16u, 32u, 64u}) {
            Random random(passes + stratified);
            std::vector<float> offset(area.x * area.y);
            for (float& x : offset) x = random.unit();
            Film film(testGpu(), area, few);
            for (uint pass = 0; pass < passes; pass++) {
                std::vector<float> samples(std::size_t(own.SAMPLE_COLUMNS) * area.x * area.y);
                // Van der Corput's sequence, shifted in each pixel: the mean over passes of a smooth function falls
                // faster than its root.
                float radical = 0;
                for (uint bit = 0; bit < 16; bit++) radical += float(pass >> bit & 1) * std::exp2(-float(bit) - 1);
                for (std::size_t i = 0; i < offset.size(); i++) {
                    const float u = stratified ? std::fmod(radical + offset[i], 1.0f) : random.unit();
                    const float rough = random.unit(); // and one that does not
                    samples[own.COLUMN_DIRECT * offset.size() + i] = u + 0.3f * rough;
                }
                Recording recording(testGpu());
                film.begin(recording, pass);
                take(film, recording, samples, 0, area.x * area.y);
                film.end();
            }
            const std::vector<Pixel> pixels = film.download();
            double inside = 0, squares = 0, noise = 0;
            for (const Pixel& pixel : pixels) {
                const double error = double(pixel.mean.layers[LAYER_DIRECT].x) - 0.65;
                inside += std::abs(error) <= double(halfInterval(pixel, noiseFreedom(film.ranges())).x);
                squares += error * error;
                noise += double(pixel.noise.x) * double(pixel.noise.x);
            }
            inside /= double(pixels.size());
            std::printf("%s, %u passes: %.3f inside, noise %.3f of the error\n",
                        stratified ? "stratified" : "independent", passes, inside, std::sqrt(noise / squares));
            EXPECT_GT(inside, 0.85) << stratified << " " << passes;
            EXPECT_LT(inside, 0.95) << stratified << " " << passes;
            EXPECT_NEAR(std::sqrt(noise / squares), 1, stratified ? 0.25 : 0.1) << stratified << " " << passes;
        }
}

TEST(Film, ColumnsThatAreLeftOutAreZeroAndChangeNoOther) {
    Features few;
    askFor(1u << LAYER_DIRECT | 1u << LAYER_INDIRECT | 1u << ASK_DEPTH | 1u << ASK_NOISE, few);
    const Columns own(few);
    const uint pixels = size.x * size.y;
    Film film(testGpu(), size, few), all(testGpu(), size);
    for (uint pass = 0; pass < 6; pass++) {
        const std::vector<float> full = samplesOf(pass);
        std::vector<float> part(own.SAMPLE_COLUMNS * pixels), zeroed(full.size());
        for (const auto& [from, to, count] : {std::tuple{columns.COLUMN_DIRECT, own.COLUMN_DIRECT, 3u},
                                              {columns.COLUMN_INDIRECT, own.COLUMN_INDIRECT, 3u},
                                              {columns.COLUMN_DEPTH, own.COLUMN_DEPTH, 2u}}) {
            std::copy_n(full.begin() + from * pixels, count * pixels, part.begin() + to * pixels);
            std::copy_n(full.begin() + from * pixels, count * pixels, zeroed.begin() + from * pixels);
        }
        for (auto&& [target, samples] : {std::pair<Film*, std::vector<float>*>{&film, &part}, {&all, &zeroed}}) {
            Recording recording(testGpu());
            target->begin(recording, pass);
            take(*target, recording, *samples, 0, pixels);
            target->end();
        }
    }
    expectSameBits(film.download(), all.download());
}

TEST(Film, CountsWhatIsNotFiniteAsBlack) {
    Film film(testGpu(), {2, 1});
    std::vector<float> values(2 * columns.SAMPLE_COLUMNS);
    values[2 * columns.COLUMN_DIRECT] = NAN;
    values[2 * columns.COLUMN_DIRECT + 2] = 1;
    values[2 * columns.COLUMN_CAUSTIC + 1] = INFINITY;
    for (uint c = 0; c < 3; c++) values[2 * (columns.COLUMN_DIRECT + c) + 1] = 2;
    Recording recording(testGpu());
    film.begin(recording, 0);
    take(film, recording, values, 0, 2);
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
