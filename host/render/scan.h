/// Prefix sums on the device.
#pragma once
#include "gpu/recording.h"
#include "shared_sort.h"

namespace vkpm {

/// Exclusive prefix sums; a long array is cut into blocks, whose sums are scanned in between.
class Scan {
public:
    explicit Scan(Gpu& gpu);

    /// Records that the first `count` values become their prefix sums, with the total behind them. A sum to begin with,
    /// which becomes the total, may be given.
    void record(Recording& recording, const Buffer<uint>& values, uint count, Ptr<uint> total = {});

private:
    Gpu& gpu;
    Kernel<ScanArgs> kernel;
    Buffer<uint> sums; // of the blocks, once an array is long
};

} // namespace vkpm
