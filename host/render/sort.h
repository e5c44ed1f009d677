/// A stable sort of key-value pairs on the device.
#pragma once
#include "gpu/recording.h"
#include "shared_paths.h"
#include "shared_sort.h"

namespace vkpm {

/// Least-significant-digit radix sort (reduce, then scan): no spinning, any subgroup width.
class Sort {
public:
    explicit Sort(Gpu& gpu);

    /// Makes room for `count` pairs; keeps what it has if that is enough.
    void reserve(std::uint64_t count);
    /// Records the sort of the first `count` pairs of `keys` and `values` by the lowest `bits` bits of the keys.
    void sort(Recording& recording, uint count, uint bits);

    Buffer<uint> keys;
    Buffer<uint> values;
    Buffer<uint> spareKeys; // free between sorts
    Buffer<uint> spareValues;

private:
    Gpu& gpu;
    Buffer<uint> sums;
    Buffer<Queue> queue;
    Kernel<SortCountArgs> countDigits;
    Kernel<ScanArgs> scan;
    Kernel<SortScatterArgs> scatter;
};

} // namespace vkpm
