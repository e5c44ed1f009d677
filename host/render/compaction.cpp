/// Stream compaction.
#include "render/compaction.h"
#include <algorithm>
#include <cassert>
#include <utility>

namespace vkpm {

Compaction::Compaction(Gpu& gpu, const std::string& name, uint capacity, uint kindCount)
    : queues(gpu, name + " queues", kindCount + 1), list(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      flags(gpu, name + " flags", COMPACTION_SUMS + std::uint64_t(capacity)), kinds(kindCount),
      nextQueues(gpu, name + " queues", kindCount + 1),
      nextList(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      nextFlags(gpu, name + " flags", COMPACTION_SUMS + std::uint64_t(capacity)), kernel(gpu, "compact") {
    assert(capacity <= COMPACTION_BLOCK * MAX_COMPACTION_BLOCKS);
}

static Queue queueOf(uint groups, uint count) {
    const uint columns = std::clamp(groups, 1u, 65535u);
    return {columns, (groups + columns - 1) / columns, 1, 0, count, 0};
}

void Compaction::start(Recording& recording, uint count) {
    std::vector<Queue> initial(kinds + 1, Queue{0, 0, 1, 0, 0, 0});
    initial[0] = queueOf((count + GROUP - 1) / GROUP, count);
    initial[kinds] = queueOf(std::max((count + COMPACTION_BLOCK - 1) / COMPACTION_BLOCK, 1u), 0);
    recording.write(queues, std::span<const Queue>(initial));
    recording.write(flags, std::span<const uint>(std::vector<uint>(COMPACTION_SUMS)));
}

void Compaction::compact(Recording& recording, uint round, bool isLast, Ptr<PathRounds> progress) {
    recording.run(kernel, queues, kinds,
                  {queues, list, flags, nextQueues, nextList, nextFlags, progress, kinds, round, isLast});
    std::swap(queues, nextQueues);
    std::swap(list, nextList);
    std::swap(flags, nextFlags);
}

} // namespace vkpm
