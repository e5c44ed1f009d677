/// Stream compaction: tally, scan, compact, enqueue.
#include "render/compaction.h"
#include "shared_paths.h"
#include <algorithm>
#include <utility>

namespace vkpm {

Compaction::Compaction(Gpu& gpu, const std::string& name, uint capacity, uint kindCount)
    : queues(gpu, name + " queues", kindCount), list(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      flags(gpu, name + " flags", capacity), kinds(kindCount),
      blocks((capacity + COMPACTION_BLOCK - 1) / COMPACTION_BLOCK), nextQueues(gpu, name + " queues", kindCount),
      nextList(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      sums(gpu, name + " sums", std::uint64_t(blocks) * kindCount + 1), tally(gpu, "compact_count"), scan(gpu, "scan"),
      scatter(gpu, "compact") {}

void Compaction::start(Recording& recording, uint count) {
    const uint groups = (count + GROUP - 1) / GROUP;
    const uint columns = std::clamp(groups, 1u, 65535u);
    std::vector<Queue> initial(kinds, Queue{0, 0, 1, 0, 0, 0});
    initial[0] = Queue{columns, (groups + columns - 1) / columns, 1, 0, count, 0};
    recording.write(queues, std::span<const Queue>(initial));
}

void Compaction::compact(Recording& recording) {
    recording.run(tally, blocks, {queues, flags, sums, kinds});
    recording.run(scan, GROUP, {sums, queues, {}, kinds, COMPACTION_BLOCK});
    recording.run(scatter, blocks, {queues, list, flags, sums, nextQueues, nextList, kinds});
    std::swap(queues, nextQueues);
    std::swap(list, nextList);
}

} // namespace vkpm
