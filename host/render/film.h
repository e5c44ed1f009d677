/// The film: running means and variance of every pixel, on the device.
#pragma once
#include "gpu/recording.h"

namespace vkpm {

class Film {
public:
    Film(Gpu& gpu, uvec2 size);

    /// Takes the samples of pixels first .. first + count - 1 into means over `passes` earlier passes.
    void add(const Buffer<Sample>& samples, uint first, uint count, uint passes);
    /// 8-bit sRGB colours of the beauty under an exposure in stops, row 0 on top.
    std::vector<uint> develop(float exposure);
    std::vector<Pixel> download() const { return pixels.download(); }
    /// Samples that were not finite, by layer.
    std::array<std::uint64_t, LAYER_COUNT> nonfinite() const;

private:
    Gpu& gpu;
    uint count;
    Buffer<Pixel> pixels;
    Buffer<Status> status;
    Kernel<FilmArgs> film;
};

} // namespace vkpm
