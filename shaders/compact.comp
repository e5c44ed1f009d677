// Writes the list of each kind of flag, in the order of the list that was flagged, and its queue. A group takes a block
// of places, an invocation a part of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "compaction.glsl"
#include "shared_paths.h"

ARGS(CompactArgs)

const uint PART = COMPACTION_BLOCK / GROUP;
shared uvec4 counts[GROUP];

uint blocksOf(uint count) { return (count + COMPACTION_BLOCK - 1u) / COMPACTION_BLOCK; }

// How many groups a dispatch has.
Queue queueOf(uint groups, uint first, uint count, uint base) {
    uint columns = min(groups, 65535u);
    uint rows = columns == 0u ? 0u : (groups + columns - 1u) / columns;
    return Queue(columns, rows, 1u, first, count, base);
}

// The queue that the next steps run on. Without paths there is one more round of one group, after which both sets of
// queues are empty, and then none: what is recorded in vain costs next to nothing.
void writeQueue(uint kind, uint first, uint count) {
    bool isEmpty = args.queues.at[0].count == 0u;
    Queue old = args.queues.at[kind];
    Queue next = queueOf((count + GROUP - 1u) / GROUP, first, count, old.base + old.count);
    args.nextQueues.at[kind] = next;
    if (kind == QUEUE_CONTINUE) {
        Queue groups = queueOf(isEmpty ? 0u : max(blocksOf(count), 1u), 0u, 0u, 0u);
        args.nextQueues.at[args.kinds] = groups;
        if (isEmpty) args.queues.at[args.kinds] = groups;
        if (count > 0u && args.progress != uvec2(0u)) {
            PathRoundsPtr(args.progress).at[0].rounds = max(PathRoundsPtr(args.progress).at[0].rounds, args.round);
            if (args.isLast != 0u) PathRoundsPtr(args.progress).at[0].unfinished = 1u;
        }
    }
    if (isEmpty) args.queues.at[kind] = next;
}

void main() {
    uint count = args.queues.at[0].count;
    uint first = args.queues.at[0].first;
    uint blocks = blocksOf(count);
    uint block = groupIndex();
    uint index = gl_LocalInvocationIndex;

    // The sums for the flags of the next round, which has no more blocks.
    uint all = gl_NumWorkGroups.x * gl_NumWorkGroups.y * GROUP;
    for (uint i = threadIndex(); i < args.kinds * blocks; i += all)
        args.nextFlags.at[sumAt(i / blocks, i % blocks)] = 0u;

    // Where each kind starts in the new list, and how many of it the blocks before have.
    uint next[EYE_QUEUES];
    uint start = 0u;
    for (uint kind = 0u; kind < args.kinds; kind++) {
        uint total = 0u, before = 0u;
        for (uint i = 0u; i < blocks; i++) {
            uint sum = args.flags.at[sumAt(kind, i)];
            if (i < block) before += sum;
            total += sum;
        }
        if (block == 0u && index == 0u) writeQueue(kind, start, total);
        next[kind] = start + before;
        start += total;
    }

    // How many of each kind the parts before have, of all kinds that there may be, so that loops are unrolled.
    uint begin = min(block * COMPACTION_BLOCK + index * PART, count);
    uint end = min(begin + PART, min((block + 1u) * COMPACTION_BLOCK, count));
    uvec4 own = uvec4(0u);
    for (uint place = begin; place < end; place++)
        own += uvec4(args.flags.at[COMPACTION_SUMS + place]) >> uvec4(0u, 1u, 2u, 3u) & 1u;
    counts[index] = own;
    barrier();
    uvec4 earlier = uvec4(0u);
    for (uint i = 0u; i < index; i++) earlier += counts[i];

    for (uint kind = 0u; kind < EYE_QUEUES; kind++) next[kind] = kind < args.kinds ? next[kind] + earlier[kind] : 0u;
    for (uint place = begin; place < end; place++) {
        uint flags = args.flags.at[COMPACTION_SUMS + place];
        uint slot = args.list.at[first + place];
        for (uint kind = 0u; kind < EYE_QUEUES; kind++)
            if ((flags >> kind & 1u) != 0u) args.nextList.at[next[kind]++] = slot;
    }
}
