// Sets up the queues of a compaction from the scanned sums, also when there is nothing left to do.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(EnqueueArgs)

void main() {
    // The queue that was compacted is one of those set up: read it first.
    uint groups = (args.queues.at[0].count + GROUP - 1u) / GROUP;
    barrier();
    uint kind = gl_LocalInvocationIndex;
    if (kind >= args.kinds) return;
    uint first = args.sums.at[kind * groups];
    uint count = args.sums.at[(kind + 1u) * groups] - first;
    Queue old = args.queues.at[kind];
    uint dispatchGroups = (count + GROUP - 1u) / GROUP;
    uint columns = min(dispatchGroups, 65535u);
    uint rows = columns == 0u ? 0u : (dispatchGroups + columns - 1u) / columns;
    args.queues.at[kind] = Queue(columns, rows, 1u, first, count, old.base + old.count);
}
