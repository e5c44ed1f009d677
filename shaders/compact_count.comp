// Counts the flags of each kind in each block of a list: the first step of a compaction. An invocation takes a block,
// so that there is nothing to agree on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_paths.h"

ARGS(CompactCountArgs)

void main() {
    uint count = args.queue.at[0].count;
    uint blocks = (count + COMPACTION_BLOCK - 1u) / COMPACTION_BLOCK;
    uint block = threadIndex();
    if (block >= blocks) return;

    // A byte for each kind; a block has fewer.
    uint counts = 0u;
    uint last = min((block + 1u) * COMPACTION_BLOCK, count);
    for (uint place = block * COMPACTION_BLOCK; place < last; place++) {
        uint flags = args.flags.at[place];
        counts += (flags & 1u) | (flags & 2u) << 7 | (flags & 4u) << 14 | (flags & 8u) << 21;
    }
    for (uint kind = 0u; kind < args.kinds; kind++) args.sums.at[kind * blocks + block] = counts >> 8u * kind & 255u;
}
