/// The film: sums over passes and the spread of every pixel, on the device.
#pragma once
#include "gpu/recording.h"
#include "render/pass_runs.h"
#include "render/pixel.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_paths.h"
#include <algorithm>
#include <array>
#include <functional>

namespace vkpm {

/// Some rows of a film: means, and the sums of each run that they are made of, with `skipped` pixels more at their
/// beginning.
struct FilmRows {
    std::vector<Pixel> pixels;
    std::vector<std::vector<PixelSum>> sums;
    std::size_t skipped = 0;
};

/// Passes come in ascending order, or as runs that an earlier film had; the same passes give the same bits either way.
class Film {
public:
    /// A film has the columns that the features say, and takes samples that have them.
    /// Its sums are kept in blocks of whole rows, of about `blockPixels`, so that no index in one and no allocation is
    /// too large.
    Film(Gpu& gpu, uvec2 pixels, const Features& features = {}, uint blockPixels = 1u << 22);

    /// Records the room for a pass, the one after the last.
    void begin(Recording& recording, uint pass);
    /// Records taking the pass's samples of pixels first .. first + count - 1, unless `unfinished` points to another
    /// number than 0; a column of the samples is `stride` long.
    void add(Recording& recording, const Buffer<float>& samples, uint stride, uint first, uint count,
             Ptr<uint> unfinished = {});
    /// Ends the pass; it is never cancelled.
    void end();

    /// Takes over runs of passes, the first of which begins where the film ends; `sums` gives those of some rows, of
    /// each run.
    void restore(std::span<const PassRange> passes,
                 const std::function<std::vector<std::vector<PixelSum>>(uint firstRow, uint rows)>& sums);
    void restore(PassRange passes, std::span<const PixelSum> sums);
    std::size_t runCount() const { return runs.size(); }
    PassRange run(std::size_t index) const { return runs[index].passes; }
    /// The sums of a run; of some rows, from any thread.
    std::vector<PixelSum> sums(std::size_t index, uint firstRow, uint rows) const;
    std::vector<PixelSum> sums(std::size_t index) const { return sums(index, 0, size.y); }

    /// The passes taken so far.
    PassRange passes() const;
    uint passCount() const { return length(passes()); }
    /// The runs that it keeps.
    std::vector<PassRange> ranges() const;

    /// The means of all passes, and their noise (see render/noise.h); of some rows, from any thread.
    std::vector<Pixel> pixels(uint firstRow, uint rows) const { return this->rows(firstRow, rows).pixels; }
    FilmRows rows(uint firstRow, uint count) const;
    std::vector<Pixel> download() const;
    /// Samples that were not finite, by layer.
    std::array<std::uint64_t, LAYER_COUNT> nonfinite() const;

private:
    using Sums = std::vector<Buffer<float>>; // [block][column][pixel]
    struct Run {
        PassRange passes;
        Sums sums;
    };
    /// Pixels of a range that one block has.
    struct Part {
        uint block;
        uint inBlock; // the first, of the block
        uint inRange; // the first, of the range
        uint count;
    };

    Sums emptySums();
    uint pixelsOf(uint block) const { return std::min(blockPixels, count - block * blockPixels); }
    std::vector<Part> partsOf(uint first, uint pixels) const;
    Run& append(PassRange passes);
    void joinLast();

    std::reference_wrapper<Gpu> gpu;
    uvec2 size;
    uint count;
    uint blockPixels; // of all blocks but the last
    Columns columns;
    std::vector<Run> runs; // adjacent, ascending
    Sums spare;
    Buffer<Status> status;
    Kernel<FilmArgs> film;
    Kernel<JoinArgs> join;
};

} // namespace vkpm
