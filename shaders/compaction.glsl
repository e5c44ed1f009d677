// Flags of the paths in a queue: which queues they go to next. Before them are sums that compaction begins with: how
// many places of each COMPACTION_BLOCK have each kind of flag.
#ifndef COMPACTION_GLSL
#define COMPACTION_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "common.glsl"
#include "shared_paths.h"

uint sumAt(uint kind, uint block) { return kind * MAX_COMPACTION_BLOCKS + block; }

// The flags of a place; an invocation has its own, of the same index. Sums of integers depend neither on their order
// nor on which lanes are together, and the lanes of a group are in one block.
void putFlags(uintPtr flags, uint place, uint kinds, uint value) {
    flags.at[COMPACTION_SUMS + place] = value;
    [[dont_unroll]] for (uint kind = 0u; kind < kinds; kind++) {
        uint sum = subgroupAdd(value >> kind & 1u);
        if (subgroupElect() && sum > 0u) atomicAdd(flags.at[sumAt(kind, place / COMPACTION_BLOCK)], sum);
    }
}

#endif
