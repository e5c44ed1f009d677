// Writes the list of each kind of flag, in the order of the list that was flagged, and its queue: the last step of a
// compaction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_paths.h"

ARGS(CompactArgs)

// Where a kind starts in the new list; blocks may be 0.
uint firstOf(uint kind, uint blocks) { return args.sums.at[kind * blocks]; }

// The queue that the next steps run on.
void writeQueue(uint kind, uint blocks) {
    uint first = firstOf(kind, blocks);
    uint count = firstOf(kind + 1u, blocks) - first;
    Queue old = args.queues.at[kind];
    uint groups = (count + GROUP - 1u) / GROUP;
    uint columns = min(groups, 65535u);
    uint rows = columns == 0u ? 0u : (groups + columns - 1u) / columns;
    args.nextQueues.at[kind] = Queue(columns, rows, 1u, first, count, old.base + old.count);
}

void main() {
    uint count = args.queues.at[0].count;
    uint first = args.queues.at[0].first;
    uint blocks = (count + COMPACTION_BLOCK - 1u) / COMPACTION_BLOCK;
    uint block = threadIndex();
    if (block < args.kinds) writeQueue(block, blocks);
    if (block >= blocks) return;

    // All kinds there may be, so that the loops are unrolled; one that there is not has no flags.
    uint next[EYE_QUEUES];
    for (uint kind = 0u; kind < EYE_QUEUES; kind++)
        next[kind] = args.sums.at[min(kind, args.kinds - 1u) * blocks + block];
    uint last = min((block + 1u) * COMPACTION_BLOCK, count);
    for (uint place = block * COMPACTION_BLOCK; place < last; place++) {
        uint flags = args.flags.at[place];
        uint slot = args.list.at[first + place];
        for (uint kind = 0u; kind < EYE_QUEUES; kind++)
            if ((flags >> kind & 1u) != 0u) args.nextList.at[next[kind]++] = slot;
    }
}
