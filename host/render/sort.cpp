/// The radix sort: per digit a count, a scan and a scatter.
#include "render/sort.h"
#include "shared_paths.h"
#include "shared_sort.h"
#include <utility>

namespace vkpm {

const uint digits = 1u << SORT_BITS;

Sort::Sort(Gpu& device)
    : gpu(device), countDigits(gpu, "sort_count"), scan(gpu), scatter(gpu, "sort_scatter") {}

void Sort::reserve(std::uint64_t count) {
    if (keys.size() >= count) return;
    for (Buffer<uint>* buffer : {&keys, &values, &spareKeys, &spareValues, &sums}) *buffer = {};
    for (Buffer<uint>* buffer : {&keys, &spareKeys}) *buffer = Buffer<uint>(gpu, "sort keys", count);
    for (Buffer<uint>* buffer : {&values, &spareValues}) *buffer = Buffer<uint>(gpu, "sort values", count);
    sums = Buffer<uint>(gpu, "sort sums", (count + SORT_BLOCK - 1) / SORT_BLOCK * digits + 1);
}

void Sort::sort(Recording& recording, uint count, uint bits) {
    if (count == 0) return; // there may be no buffers
    const uint blocks = (count + SORT_BLOCK - 1) / SORT_BLOCK;
    const std::uint64_t threads = std::uint64_t(blocks) * GROUP;
    for (uint shift = 0; shift < bits; shift += SORT_BITS) {
        recording.run(countDigits, threads, {keys, sums, count, shift});
        scan.record(recording, sums, digits * blocks);
        recording.run(scatter, threads, {keys, values, spareKeys, spareValues, sums, count, shift});
        std::swap(keys, spareKeys);
        std::swap(values, spareValues);
    }
}

} // namespace vkpm
