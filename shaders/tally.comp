// Counts, for each group of 64 places in a list, the flags of each kind: the first step of a compaction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(TallyArgs)

shared uint counts[EYE_QUEUES];

void main() {
    Queue queue = args.queue.at[0];
    if (gl_LocalInvocationIndex < EYE_QUEUES) counts[gl_LocalInvocationIndex] = 0u;
    barrier();
    uint flags = threadIndex() < queue.count ? args.flags.at[threadIndex()] : 0u;
    for (uint kind = 0u; kind < args.kinds; kind++)
        if ((flags >> kind & 1u) != 0u) atomicAdd(counts[kind], 1u);
    barrier();
    uint groups = (queue.count + GROUP - 1u) / GROUP;
    if (gl_LocalInvocationIndex < args.kinds && groupIndex() < groups)
        args.sums.at[gl_LocalInvocationIndex * groups + groupIndex()] = counts[gl_LocalInvocationIndex];
}
