/// The film and its development.
#include "render/film.h"
#include <cassert>
#include <cmath>

namespace vkpm {

static uint length(PassRange passes) { return passes.end - passes.begin; }

Film::Film(Gpu& device, uvec2 size)
    : gpu(device), count(size.x * size.y), status(gpu, "film status", 1), film(gpu, "film"), join(gpu, "join") {
    Recording recording(gpu);
    recording.clear(status);
    recording.submit();
}

PassRange Film::passes() const { return runs.empty() ? PassRange{} : PassRange{runs.front().passes.begin, runs.back().passes.end}; }

Film::Run& Film::append(PassRange passes) {
    assert(runs.empty() || runs.back().passes.end == passes.begin);
    Buffer<PixelSum> sums = spare.size() ? std::move(spare) : Buffer<PixelSum>(gpu, "film", count);
    spare = {};
    return runs.emplace_back(passes, std::move(sums));
}

void Film::begin(uint pass) {
    if (!runs.empty() && joins(runs.back().passes, {pass, pass + 1})) return;
    Recording recording(gpu);
    recording.clear(append({pass, pass}).sums);
    recording.submit();
}

void Film::add(const Buffer<Sample>& samples, uint first, uint sampleCount) {
    const Run& run = runs.back();
    const float m = static_cast<float>(length(run.passes));
    Recording recording(gpu);
    recording.run(film, sampleCount, {samples, run.sums, status, first, sampleCount, m > 0 ? 1 / m : 0, m / (m + 1)});
    recording.submit();
}

void Film::end() {
    runs.back().passes.end++;
    joinLast();
}

void Film::restore(PassRange passes, std::span<const PixelSum> sums) {
    append(passes).sums.upload(sums);
    joinLast();
}

void Film::addTo(Run& run, const Run& other) {
    const float m = static_cast<float>(length(run.passes));
    const float n = static_cast<float>(length(other.passes));
    Recording recording(gpu);
    recording.run(join, count, {run.sums, other.sums, count, m > 0 ? 1 / m : 0, 1 / n, m * n / (m + n)});
    recording.submit();
    run.passes.end = other.passes.end;
}

void Film::joinLast() {
    while (runs.size() > 1 && joins(runs[runs.size() - 2].passes, runs.back().passes)) {
        addTo(runs[runs.size() - 2], runs.back());
        spare = std::move(runs.back().sums);
        runs.pop_back();
    }
}

Film::Run Film::total() {
    Run sum{{passes().begin, passes().begin}, Buffer<PixelSum>(gpu, "film total", count)};
    Recording recording(gpu);
    recording.clear(sum.sums);
    recording.submit();
    for (const Run& run : runs) addTo(sum, run);
    return sum;
}

std::vector<uint> Film::develop(float exposure) {
    const Kernel<DevelopArgs> kernel(gpu, "develop");
    const Buffer<uint> colors(gpu, "developed film", count);
    const Run sum = total();
    Recording recording(gpu);
    recording.run(kernel, count, {sum.sums, colors, count, std::exp2(exposure) / float(passCount())});
    recording.submit();
    return colors.download();
}

std::vector<Pixel> Film::download() {
    const double n = passCount();
    std::vector<Pixel> pixels;
    pixels.reserve(count);
    for (const PixelSum& pixel : total().sums.download()) {
        Pixel& mean = pixels.emplace_back(Pixel{pixel.sum, pixel.deviation});
        for (vec3& layer : mean.mean.layers) layer = vec3(glm::dvec3(layer) / n);
        mean.mean.albedo = vec3(glm::dvec3(pixel.sum.albedo) / n);
        mean.mean.normal = vec3(glm::dvec3(pixel.sum.normal) / n);
        mean.mean.depth = float(double(pixel.sum.depth) / n);
        mean.mean.covered = float(double(pixel.sum.covered) / n);
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
