/// The film, and its means on the host.
#include "render/film.h"
#include "render/noise.h"
#include "scene/luminance.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_paths.h"
#include <algorithm>
#include <cassert>
#include <cmath>
#include <tbb/parallel_for.h>
#include <utility>

namespace vkpm {
namespace {

using glm::dvec3;

/// Where a column of PixelSum is among those of a film, and how many floats it has there: none if the film is without
/// it.
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

/// Calls `use` with the places of each float in a PixelSum and among the columns of a film.
template <class Use> void forEachFloat(const Columns& film, Use use) {
    for (const Place& place : placesOf(film))
        for (uint k = 0; k < place.floats; k++) use(place.inPixel + k, place.inFilm + k);
}

const uint rowsAtOnce = 32;

/// While it lives, no submission is cancelled.
struct Uninterrupted {
    explicit Uninterrupted(Gpu& device) : gpu(device), flag(std::exchange(gpu.cancel, nullptr)) {}
    ~Uninterrupted() { gpu.cancel = flag; }
    Uninterrupted(const Uninterrupted&) = delete;
    Uninterrupted& operator=(const Uninterrupted&) = delete;
    Gpu& gpu;
    const std::atomic<bool>* flag;
};

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
    const double mean = luminance(bias) / n;
    if (n > 1) pixel.biasNoise = float(std::sqrt(std::max(0.0, square / n - mean * mean) / (n - 1)));
    return pixel;
}

} // namespace

Film::Film(Gpu& device, uvec2 pixels, const Features& features, uint wanted)
    : gpu(device), size(pixels), count(size.x * size.y), blockPixels(std::max(wanted / size.x, 1u) * size.x),
      columns(features), status(gpu, "film status", 1), film(gpu, "film", features), join(gpu, "join", features) {
    status.upload(std::vector(1, Status{}));
}

PassRange Film::passes() const {
    return runs.empty() ? PassRange{} : PassRange{runs.front().passes.begin, runs.back().passes.end};
}

std::vector<PassRange> Film::ranges() const {
    std::vector<PassRange> ranges;
    for (const Run& run : runs) ranges.push_back(run.passes);
    return ranges;
}

Film::Sums Film::emptySums() {
    if (!spare.empty()) return std::exchange(spare, {});
    Sums sums;
    for (uint block = 0; block * std::uint64_t(blockPixels) < count; block++)
        sums.emplace_back(gpu, "film", std::uint64_t(columns.SUM_COLUMNS) * pixelsOf(block));
    return sums;
}

std::vector<Film::Part> Film::partsOf(uint first, uint pixels) const {
    std::vector<Part> parts;
    for (uint done = 0; done < pixels;) {
        const uint block = (first + done) / blockPixels, inBlock = (first + done) % blockPixels;
        parts.push_back({block, inBlock, done, std::min(pixels - done, pixelsOf(block) - inBlock)});
        done += parts.back().count;
    }
    return parts;
}

Film::Run& Film::append(PassRange passes) {
    assert(runs.empty() || runs.back().passes.end == passes.begin);
    return runs.emplace_back(passes, emptySums());
}

void Film::begin(Recording& recording, uint pass) {
    const bool begun = !runs.empty() && length(runs.back().passes) == 0; // and left
    if (!begun && !runs.empty() && joins(runs.back().passes, {pass, pass + 1})) return;
    for (const Buffer<float>& block : (begun ? runs.back() : append({pass, pass})).sums) recording.clear(block);
}

void Film::add(Recording& recording, const Buffer<float>& samples, uint stride, uint first, uint sampleCount,
               Ptr<uint> unfinished) {
    const Run& run = runs.back();
    for (const Part& part : partsOf(first, sampleCount))
        recording.run(film, part.count,
                      {{samples.address + part.inRange * sizeof(float)},
                       run.sums[part.block],
                       status,
                       unfinished,
                       stride,
                       pixelsOf(part.block),
                       part.inBlock,
                       part.count,
                       joinWeights(run.passes, {run.passes.end, run.passes.end + 1})});
}

void Film::end() {
    const Uninterrupted here(gpu);
    runs.back().passes.end++;
    joinLast();
}

std::vector<PixelSum> Film::sums(std::size_t index, uint firstRow, uint rows) const {
    std::vector<PixelSum> sums(std::size_t(rows) * size.x, PixelSum{});
    std::vector<float> values;        // column by column
    const std::size_t together = 256; // pixels that stay in the cache
    const std::vector<Place> places = placesOf(columns);
    for (const Part& part : partsOf(firstRow * size.x, rows * size.x)) {
        const Buffer<float>& block = runs[index].sums[part.block];
        values.resize(std::size_t(part.count) * columns.SUM_COLUMNS);
        block.downloadRows(values, part.count, pixelsOf(part.block), part.inBlock);
        for (std::size_t first = 0; first < part.count; first += together)
            for (const Place& place : places)
                for (uint k = 0; k < place.floats; k++) {
                    const float* from = values.data() + std::size_t(place.inFilm + k) * part.count;
                    for (std::size_t i = first; i < std::min<std::size_t>(first + together, part.count); i++)
                        reinterpret_cast<float*>(&sums[part.inRange + i])[place.inPixel + k] = from[i];
                }
    }
    return sums;
}

void Film::restore(std::span<const PassRange> passes,
                   const std::function<std::vector<std::vector<PixelSum>>(uint, uint)>& sums) {
    std::vector<Run> restored;
    for (const PassRange range : passes) restored.push_back({range, emptySums()});
    for (uint row = 0; row < size.y; row += rowsAtOnce) {
        const std::vector<std::vector<PixelSum>> block = sums(row, std::min(rowsAtOnce, size.y - row));
        for (std::size_t run = 0; run < restored.size(); run++) {
            for (const Part& part : partsOf(row * size.x, static_cast<uint>(block[run].size()))) {
                std::vector<float> values(std::size_t(part.count) * columns.SUM_COLUMNS); // column by column
                forEachFloat(columns, [&](uint inPixel, uint inFilm) {
                    for (std::size_t i = 0; i < part.count; i++)
                        values[std::size_t(inFilm) * part.count + i] =
                            reinterpret_cast<const float*>(&block[run][part.inRange + i])[inPixel];
                });
                restored[run].sums[part.block].uploadRows(values, part.count, pixelsOf(part.block), part.inBlock);
            }
        }
    }
    for (Run& run : restored) {
        assert(runs.empty() || runs.back().passes.end == run.passes.begin);
        runs.push_back(std::move(run));
        joinLast();
    }
}

void Film::restore(PassRange passes, std::span<const PixelSum> sums) {
    restore(std::array{passes}, [&](uint row, uint rows) {
        const auto block = sums.subspan(std::size_t(row) * size.x, std::size_t(rows) * size.x);
        return std::vector<std::vector<PixelSum>>{{block.begin(), block.end()}};
    });
}

void Film::joinLast() {
    while (runs.size() > 1 && joins(runs[runs.size() - 2].passes, runs.back().passes)) {
        Run& run = runs[runs.size() - 2];
        const Run& last = runs.back();
        Recording recording(gpu);
        for (uint block = 0; block < run.sums.size(); block++)
            recording.run(join, pixelsOf(block),
                          {run.sums[block], last.sums[block], pixelsOf(block), joinWeights(run.passes, last.passes)});
        recording.submit();
        run.passes.end = last.passes.end;
        spare = std::move(runs.back().sums);
        runs.pop_back();
    }
}

FilmRows Film::rows(uint firstRow, uint count) const {
    // Noise depends on what is around.
    const uint first = firstRow - std::min(firstRow, uint(noiseReach)),
               end = std::min(firstRow + count + noiseReach, size.y);
    const std::vector<PassRange> passes = ranges();
    const uint batch = greatestBatch(passes);
    const Batches coarse = batchesOf(passes, batch), fine = batch >= 4 ? batchesOf(passes, batch / 4) : Batches{};
    FilmRows result{{}, {}, std::size_t(firstRow - first) * size.x};
    for (std::size_t i = 0; i < runs.size(); i++) result.sums.push_back(sums(i, first, end - first));

    std::vector<Spread> spreads(std::size_t(end - first) * size.x);
    result.pixels.reserve(std::size_t(count) * size.x);
    for (std::size_t p = 0; p < spreads.size(); p++) {
        Total total;
        for (std::size_t i = 0; i < runs.size(); i++) total.add(result.sums[i][p], passes[i], batch);
        spreads[p] = {total.coarse.variance(coarse), batch >= 4 ? total.fine.variance(fine) : dvec3(0)};
        if (p >= result.skipped && result.pixels.size() < std::size_t(count) * size.x)
            result.pixels.push_back(total.pixel(passCount()));
    }
    const std::vector<vec3> noise = noiseOf(spreads, {size.x, end - first}, passes);
    for (std::size_t p = 0; p < result.pixels.size(); p++) result.pixels[p].noise = noise[result.skipped + p];
    return result;
}

std::vector<Pixel> Film::download() const {
    std::vector<Pixel> all(count);
    tbb::parallel_for(0u, (size.y + rowsAtOnce - 1) / rowsAtOnce, [&](uint block) {
        const uint row = block * rowsAtOnce;
        std::ranges::copy(pixels(row, std::min(rowsAtOnce, size.y - row)), all.begin() + std::ptrdiff_t(row) * size.x);
    });
    return all;
}

std::array<std::uint64_t, LAYER_COUNT> Film::nonfinite() const {
    std::array<std::uint64_t, LAYER_COUNT> counts;
    const Status result = status.readElement();
    for (uint layer = 0; layer < LAYER_COUNT; layer++) counts[layer] = result.nonfinite[layer];
    return counts;
}

} // namespace vkpm
