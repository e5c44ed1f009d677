/// The film, and its means on the host.
#include "render/film.h"
#include "render/noise.h"
#include <algorithm>
#include <cassert>
#include <cmath>

namespace vkpm {
namespace {

using glm::dvec3;

/// Where a column of PixelSum is among those of a film, and how many floats it has there: none if the film is without it.
struct Place {
    uint inPixel;
    uint inFilm;
    uint floats;
};

std::vector<Place> placesOf(const Columns& film) {
    const Columns all;
    assert(all.SUM_COLUMNS == PIXEL_FLOATS);
    const std::array pixel{
#define X(name, value) all.name,
        COLUMNS(X)
#undef X
    };
    const std::array own{
#define X(name, value) film.name,
        COLUMNS(X)
#undef X
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i + 1 < own.size(); i++) places.push_back({pixel[i], own[i], own[i + 1] - own[i]});
    return places;
}

/// Calls `copy` with a pixel, and the places of a float in its PixelSum and among the columns of a film; some pixels at a time,
/// as many as stay in the cache.
template <class Copy> void forEachFloat(const Columns& film, uint pixels, Copy copy) {
    const std::vector<Place> places = placesOf(film);
    const uint block = 256;
    for (uint first = 0; first < pixels; first += block)
        for (const Place& place : places)
            for (uint k = 0; k < place.floats; k++)
                for (uint i = first; i < std::min(first + block, pixels); i++) copy(i, place.inPixel + k, place.inFilm + k);
}

/// Sums over runs of passes, in double precision.
struct Total {
    dvec3 layers[LAYER_COUNT]{};
    dvec3 albedo{0}, normal{0}, bias{0};
    double depth = 0, covered = 0, square = 0;
    SpreadSum coarse, fine;

    void add(const PixelSum& run, PassRange passes, uint batch);
    Pixel pixel(double passes) const;
};

void Total::add(const PixelSum& run, PassRange passes, uint batch) {
    dvec3 beauty(run.rest);
    for (uint layer = 0; layer < LAYER_COUNT; layer++) {
        layers[layer] += dvec3(run.sum.layers[layer]);
        beauty += dvec3(run.sum.layers[layer]);
    }
    albedo += dvec3(run.sum.albedo);
    normal += dvec3(run.sum.normal);
    depth += double(run.sum.depth);
    covered += double(run.sum.covered);
    bias += dvec3(run.sum.bias);
    square += double(run.square);
    coarse.add(passes, batch, beauty, dvec3(run.fine), dvec3(run.coarse));
    if (batch >= 4) fine.add(passes, batch / 4, beauty, dvec3(run.fine), dvec3(run.coarse));
}

Pixel Total::pixel(double n) const {
    Pixel pixel{};
    for (uint layer = 0; layer < LAYER_COUNT; layer++) pixel.mean.layers[layer] = vec3(layers[layer] / n);
    pixel.mean.albedo = vec3(albedo / n);
    pixel.mean.normal = vec3(normal / n);
    pixel.mean.depth = float(depth / n);
    pixel.mean.covered = float(covered / n);
    pixel.mean.bias = vec3(bias / n);
    const double mean = glm::dot(bias, dvec3(0.2126, 0.7152, 0.0722)) / n;
    if (n > 1) pixel.biasNoise = float(std::sqrt(std::max(0.0, square / n - mean * mean) / (n - 1)));
    return pixel;
}

} // namespace

Film::Film(Gpu& device, uvec2 pixels, const Features& features)
    : gpu(device), size(pixels), count(size.x * size.y), columns(features), status(gpu, "film status", 1), film(gpu, "film", features), join(gpu, "join", features) {
    status.upload(std::vector(1, Status{}));
}

PassRange Film::passes() const { return runs.empty() ? PassRange{} : PassRange{runs.front().passes.begin, runs.back().passes.end}; }

std::vector<PassRange> Film::ranges() const {
    std::vector<PassRange> ranges;
    for (const Run& run : runs) ranges.push_back(run.passes);
    return ranges;
}

Film::Run& Film::append(PassRange passes) {
    assert(runs.empty() || runs.back().passes.end == passes.begin);
    Buffer<float> sums = spare.size() ? std::move(spare) : Buffer<float>(gpu, "film", std::uint64_t(columns.SUM_COLUMNS) * count);
    spare = {};
    return runs.emplace_back(passes, std::move(sums));
}

void Film::begin(uint pass) {
    if (!runs.empty() && joins(runs.back().passes, {pass, pass + 1})) return;
    Recording recording(gpu);
    recording.clear(append({pass, pass}).sums);
    recording.submit();
}

void Film::add(const Buffer<float>& samples, uint stride, uint first, uint sampleCount) {
    const Run& run = runs.back();
    Recording recording(gpu);
    recording.run(film, sampleCount,
                  {samples, run.sums, status, stride, count, first, sampleCount, joinWeights(run.passes, {run.passes.end, run.passes.end + 1})});
    recording.submit();
}

void Film::end() {
    runs.back().passes.end++;
    joinLast();
}

std::vector<PixelSum> Film::sums(std::size_t index) const {
    const std::vector<float> values = runs[index].sums.download();
    std::vector<PixelSum> sums(count, PixelSum{});
    forEachFloat(columns, count, [&](uint i, uint inPixel, uint inFilm) {
        reinterpret_cast<float*>(&sums[i])[inPixel] = values[std::size_t(inFilm) * count + i];
    });
    return sums;
}

void Film::restore(PassRange passes, std::span<const PixelSum> sums) {
    std::vector<float> values(std::size_t(columns.SUM_COLUMNS) * count);
    forEachFloat(columns, count, [&](uint i, uint inPixel, uint inFilm) {
        values[std::size_t(inFilm) * count + i] = reinterpret_cast<const float*>(&sums[i])[inPixel];
    });
    append(passes).sums.upload(values);
    joinLast();
}

void Film::joinLast() {
    while (runs.size() > 1 && joins(runs[runs.size() - 2].passes, runs.back().passes)) {
        Run& run = runs[runs.size() - 2];
        const Run& last = runs.back();
        Recording recording(gpu);
        recording.run(join, count, {run.sums, last.sums, count, joinWeights(run.passes, last.passes)});
        recording.submit();
        run.passes.end = last.passes.end;
        spare = std::move(runs.back().sums);
        runs.pop_back();
    }
}

std::vector<Pixel> Film::download() const {
    const std::vector<PassRange> passes = ranges();
    const uint batch = greatestBatch(passes);
    std::vector<Total> totals(count);
    for (std::size_t i = 0; i < runs.size(); i++) {
        const std::vector<PixelSum> run = sums(i);
        for (uint p = 0; p < count; p++) totals[p].add(run[p], passes[i], batch);
    }

    std::vector<Spread> spreads;
    for (const Total& total : totals)
        spreads.push_back({total.coarse.variance(batchesOf(passes, batch)), batch >= 4 ? total.fine.variance(batchesOf(passes, batch / 4)) : dvec3(0)});
    const std::vector<vec3> noise = noiseOf(spreads, size, passes);
    std::vector<Pixel> pixels;
    pixels.reserve(count);
    for (uint p = 0; p < count; p++) {
        pixels.push_back(totals[p].pixel(passCount()));
        pixels.back().noise = noise[p];
    }
    return pixels;
}

std::array<std::uint64_t, LAYER_COUNT> Film::nonfinite() const {
    std::array<std::uint64_t, LAYER_COUNT> counts;
    const Status result = status.read1();
    for (uint layer = 0; layer < LAYER_COUNT; layer++) counts[layer] = result.nonfinite[layer];
    return counts;
}

} // namespace vkpm
