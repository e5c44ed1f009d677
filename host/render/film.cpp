/// The film and its development.
#include "render/film.h"
#include <cmath>

namespace vkpm {

Film::Film(Gpu& device, uvec2 size)
    : gpu(device), count(size.x * size.y), pixels(gpu, "film", count), status(gpu, "film status", 1), film(gpu, "film") {
    Recording recording(gpu);
    recording.clear(pixels);
    recording.clear(status);
    recording.submit();
}

void Film::add(const Buffer<Sample>& samples, uint first, uint sampleCount, uint passes) {
    Recording recording(gpu);
    recording.run(film, sampleCount, {samples, pixels, status, first, sampleCount, passes});
    recording.submit();
}

std::vector<uint> Film::develop(float exposure) {
    const Kernel<DevelopArgs> kernel(gpu, "develop");
    const Buffer<uint> colors(gpu, "developed film", count);
    Recording recording(gpu);
    recording.run(kernel, count, {pixels, colors, count, std::exp2(exposure)});
    recording.submit();
    return colors.download();
}

std::array<std::uint64_t, LAYER_COUNT> Film::nonfinite() const {
    std::array<std::uint64_t, LAYER_COUNT> counts;
    const Status result = status.read1();
    for (uint layer = 0; layer < LAYER_COUNT; layer++) counts[layer] = result.nonfinite[layer];
    return counts;
}

} // namespace vkpm
