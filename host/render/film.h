/// The film: sums over passes and the spread of every pixel, on the device.
#pragma once
#include "gpu/recording.h"
#include "render/pass_runs.h"

namespace vkpm {

/// Passes come in ascending order, or as runs that an earlier film had; the same passes give the same bits either way.
class Film {
public:
    Film(Gpu& gpu, uvec2 size);

    /// Makes room for a pass, the one after the last.
    void begin(uint pass);
    /// Takes the pass's samples of pixels first .. first + count - 1.
    void add(const Buffer<Sample>& samples, uint first, uint count);
    /// Ends the pass.
    void end();

    /// Takes over a run of passes that begins where the film ends.
    void restore(PassRange passes, std::span<const PixelSum> sums);
    std::size_t runCount() const { return runs.size(); }
    PassRange run(std::size_t index) const { return runs[index].passes; }
    std::vector<PixelSum> sums(std::size_t index) const { return runs[index].sums.download(); }

    /// The passes taken so far.
    PassRange passes() const;
    uint passCount() const { return passes().end - passes().begin; }

    /// 8-bit sRGB colours of the beauty under an exposure in stops, row 0 on top.
    std::vector<uint> develop(float exposure);
    /// The means of all passes.
    std::vector<Pixel> download();
    /// Samples that were not finite, by layer.
    std::array<std::uint64_t, LAYER_COUNT> nonfinite() const;

private:
    struct Run {
        PassRange passes;
        Buffer<PixelSum> sums;
    };

    Run& append(PassRange passes);
    void joinLast();
    void addTo(Run& run, const Run& other);
    Run total();

    Gpu& gpu;
    uint count;
    std::vector<Run> runs; // adjacent, ascending
    Buffer<PixelSum> spare;
    Buffer<Status> status;
    Kernel<FilmArgs> film;
    Kernel<JoinArgs> join;
};

} // namespace vkpm
