/// The radix sort: per digit a count, a scan and a scatter.
#include "render/sort.h"
#include "shared_paths.h"
#include "shared_sort.h"
#include <utility>

namespace vkpm {

const uint digits = 1u << SORT_BITS;

Sort::Sort(Gpu& device)
    : gpu(device), queue(gpu, "sort queue", 1), countDigits(gpu, "sort_count"), scan(gpu, "scan"),
      scatter(gpu, "sort_scatter") {}

void Sort::reserve(std::uint64_t count) {
    if (keys.size() >= count) return;
    for (Buffer<uint>* buffer : {&keys, &values, &spareKeys, &spareValues, &sums}) *buffer = {};
    for (Buffer<uint>* buffer : {&keys, &spareKeys}) *buffer = Buffer<uint>(gpu, "sort keys", count);
    for (Buffer<uint>* buffer : {&values, &spareValues}) *buffer = Buffer<uint>(gpu, "sort values", count);
    sums = Buffer<uint>(gpu, "sort sums", (count + SORT_BLOCK - 1) / SORT_BLOCK * digits + 1);
}

void Sort::sort(Recording& recording, uint count, uint bits) {
    if (count == 0) return; // there may be no buffers
    const Queue whole{.count = count};
    recording.write(queue, std::span(&whole, 1));
    const std::uint64_t threads = std::uint64_t((count + SORT_BLOCK - 1) / SORT_BLOCK) * GROUP;
    for (uint shift = 0; shift < bits; shift += SORT_BITS) {
        recording.run(countDigits, threads, {keys, sums, count, shift});
        recording.run(scan, GROUP, {sums, queue, {}, digits, SORT_BLOCK});
        recording.run(scatter, threads, {keys, values, spareKeys, spareValues, sums, count, shift});
        std::swap(keys, spareKeys);
        std::swap(values, spareValues);
    }
}

} // namespace vkpm
