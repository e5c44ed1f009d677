/// Stream compaction.
#include "render/compaction.h"
#include <algorithm>
#include <cassert>
#include <utility>

namespace vkpm {

Compaction::Compaction(Gpu& gpu, const std::string& name, uint capacity, uint kindCount)
    : queues(gpu, name + " queues", kindCount), list(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      flags(gpu, name + " flags", COMPACTION_SUMS + std::uint64_t(capacity)), kinds(kindCount),
      nextQueues(gpu, name + " queues", kindCount), nextList(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      nextFlags(gpu, name + " flags", COMPACTION_SUMS + std::uint64_t(capacity)),
      blocks(std::max((capacity + COMPACTION_BLOCK - 1) / COMPACTION_BLOCK, 1u)), kernel(gpu, "compact") {
    assert(blocks <= MAX_COMPACTION_BLOCKS);
}

void Compaction::start(Recording& recording, uint count) {
    const uint groups = (count + GROUP - 1) / GROUP;
    const uint columns = std::clamp(groups, 1u, 65535u);
    std::vector<Queue> initial(kinds, Queue{0, 0, 1, 0, 0, 0});
    initial[0] = Queue{columns, (groups + columns - 1) / columns, 1, 0, count, 0};
    recording.write(queues, std::span<const Queue>(initial));
    recording.write(flags, std::span<const uint>(std::vector<uint>(COMPACTION_SUMS)));
}

void Compaction::compact(Recording& recording) {
    recording.run(kernel, std::uint64_t(blocks) * GROUP, {queues, list, flags, nextQueues, nextList, nextFlags, kinds});
    std::swap(queues, nextQueues);
    std::swap(list, nextList);
    std::swap(flags, nextFlags);
}

} // namespace vkpm
