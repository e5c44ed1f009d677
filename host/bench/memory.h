/// Sorting and copying, beside the host's own.
#pragma once
#include "bench/measure.h"

namespace vkpm {

/// Milliseconds to sort 2^20 pairs by 32-bit keys: Sort against std::stable_sort on all threads.
Measurement measureSort(Gpu& gpu);

/// Bytes per second, read and written, of the arrange kernel: photons copied in order against memcpy on all threads,
/// and in random order against the same loop on all threads.
std::vector<Measurement> measureCopies(Gpu& gpu);

} // namespace vkpm
