/// Prefix sums, of long arrays in two levels.
#include "render/scan.h"

namespace vkpm {

// Arrays of more than so many blocks are long. One group is faster than three dispatches before that.
const uint shortBlocks = 8;

Scan::Scan(Gpu& device) : gpu(device), kernel(gpu, "scan") {}

void Scan::record(Recording& recording, const Buffer<uint>& values, uint count, Ptr<uint> total) {
    const uint blocks = (count + SCAN_BLOCK - 1) / SCAN_BLOCK;
    if (blocks <= shortBlocks) {
        recording.run(kernel, GROUP, {values, {}, total, total, count, count});
        return;
    }
    if (sums.size() < blocks + 1ull) {
        sums = {};
        sums = Buffer<uint>(gpu, "block sums", blocks + 1ull);
    }
    const std::uint64_t threads = std::uint64_t(blocks) * GROUP;
    recording.run(kernel, threads, {values, sums, {}, {}, count, SCAN_BLOCK});
    recording.run(kernel, GROUP, {sums, {}, total, total, blocks, blocks});
    recording.run(kernel, threads, {values, {}, sums, {}, count, SCAN_BLOCK});
}

} // namespace vkpm
