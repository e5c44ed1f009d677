/// Sorting paths into queues: which of them go on, and what else they ask for.
#pragma once
#include "gpu/recording.h"
#include "shared_paths.h"

namespace vkpm {

/// Queues of paths and the lists they point into. Paths are flagged by a kernel (see compaction.glsl); compact() makes
/// a list of each kind of flag, in the order of the paths, by prefix sums, so that nothing depends on scheduling.
class Compaction {
public:
    /// For up to `capacity` paths and `kinds` kinds of flags; `name` goes before the names of the buffers.
    Compaction(Gpu& gpu, const std::string& name, uint capacity, uint kinds);

    /// The first queue holds all places of `list` from 0 to count - 1, the others nothing.
    void start(Recording& recording, uint count);
    /// Records the compaction of the first queue's flags, after which `list` is the new list. Paths that go on after a
    /// `round`, counted from 1, are noted in `progress`. Rounds without paths may be recorded: they cost little.
    void compact(Recording& recording, uint round = 0, bool isLast = false, Ptr<PathRounds> progress = {});

    Buffer<Queue> queues; // one per kind, then that of this kernel
    Buffer<uint> list;    // of paths, queue after queue
    Buffer<uint> flags;   // sums, then by place in the first queue

private:
    uint kinds;
    Buffer<Queue> nextQueues;
    Buffer<uint> nextList;
    Buffer<uint> nextFlags;
    Kernel<CompactArgs> kernel;
};

} // namespace vkpm
