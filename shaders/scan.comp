// Exclusive prefix sums of an array, with the total behind it. A group takes a block: all of a short array, or of a long
// one first the sums of its blocks, and then, when these were scanned, each block from there on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_sort.h"

ARGS(ScanArgs)

shared uint totals[GROUP];

void main() {
    // Each invocation adds up a part of its own.
    uint block = groupIndex();
    if (block > 0u && block * args.blockSize >= args.count) return;
    uint begin = block * args.blockSize, end = min(begin + args.blockSize, args.count);
    uint part = (end - begin + GROUP - 1u) / GROUP;
    uint first = min(begin + gl_LocalInvocationIndex * part, end);
    uint last = min(first + part, end);
    uint sum = 0u;
    for (uint i = first; i < last; i++) sum += args.values.at[i];
    totals[gl_LocalInvocationIndex] = sum;
    uint before = args.before != uvec2(0u) ? uintPtr(args.before).at[block] : 0u;
    barrier();

    // What lies before the part, then the sums within it.
    for (uint i = 0u; i < gl_LocalInvocationIndex; i++) before += totals[i];
    bool isLast = gl_LocalInvocationIndex == GROUP - 1u;
    if (args.sums != uvec2(0u)) {
        if (isLast) uintPtr(args.sums).at[block] = before + sum;
        return;
    }
    for (uint i = first; i < last; i++) {
        uint value = args.values.at[i];
        args.values.at[i] = before;
        before += value;
    }
    if (!isLast || end < args.count) return;
    args.values.at[args.count] = before;
    if (args.total != uvec2(0u)) uintPtr(args.total).at[0] = before;
}
