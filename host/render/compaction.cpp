/// Stream compaction: tally, scan, compact, enqueue.
#include "render/compaction.h"
#include <algorithm>
#include <utility>

namespace vkpm {

Compaction::Compaction(Gpu& gpu, const std::string& name, uint capacity, uint kindCount)
    : queues(gpu, name + " queues", kindCount), list(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      flags(gpu, name + " flags", capacity), kinds(kindCount), nextList(gpu, name + " lists", std::uint64_t(capacity) * kindCount),
      sums(gpu, name + " sums", std::uint64_t(capacity / GROUP + 1) * kindCount + 1), tally(gpu, "tally"), scan(gpu, "scan"),
      scatter(gpu, "compact"), enqueue(gpu, "enqueue") {}

void Compaction::start(uint count) {
    const uint groups = (count + GROUP - 1) / GROUP;
    const uint columns = std::clamp(groups, 1u, 65535u);
    std::vector<Queue> initial(kinds, Queue{0, 0, 1, 0, 0, 0});
    initial[0] = Queue{columns, (groups + columns - 1) / columns, 1, 0, count, 0};
    queues.upload(initial);
}

void Compaction::compact(Recording& recording) {
    recording.run(tally, queues, 0, {queues, flags, sums, kinds});
    recording.run(scan, GROUP, {sums, queues, kinds, GROUP});
    recording.run(scatter, queues, 0, {queues, list, flags, sums, nextList, kinds});
    recording.run(enqueue, GROUP, {queues, sums, kinds});
    std::swap(list, nextList);
}

} // namespace vkpm
