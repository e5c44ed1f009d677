// Writes the list of each kind of flag, in the order of the list that was flagged: the last step of a compaction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(CompactArgs)

shared uvec2 masks[EYE_QUEUES]; // who of this group has the flag

uint rank(uvec2 mask, uint index) {
    uint low = index < 32u ? (1u << index) - 1u : 0xffffffffu;
    uint high = index < 32u ? 0u : (1u << (index - 32u)) - 1u;
    return bitCount(mask.x & low) + bitCount(mask.y & high);
}

void main() {
    Queue queue = args.queue.at[0];
    uint groups = (queue.count + GROUP - 1u) / GROUP;
    uint index = gl_LocalInvocationIndex;
    if (index < EYE_QUEUES) masks[index] = uvec2(0u);
    barrier();
    uint flags = threadIndex() < queue.count ? args.flags.at[threadIndex()] : 0u;
    for (uint kind = 0u; kind < args.kinds; kind++) {
        if ((flags >> kind & 1u) == 0u) continue;
        if (index < 32u) atomicOr(masks[kind].x, 1u << index);
        else atomicOr(masks[kind].y, 1u << (index - 32u));
    }
    barrier();

    uint slot = flags != 0u ? args.list.at[queue.first + threadIndex()] : 0u;
    for (uint kind = 0u; kind < args.kinds; kind++)
        if ((flags >> kind & 1u) != 0u) args.nextList.at[args.sums.at[kind * groups + groupIndex()] + rank(masks[kind], index)] = slot;
}
