// Exclusive prefix sum of an array by one work group, with the total behind it; the sum of earlier arrays may go
// before.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_sort.h"

ARGS(ScanArgs)

shared uint totals[GROUP];

void main() {
    // Each invocation adds up a part of its own.
    uint count = args.kinds * ((args.queue.at[0].count + args.blockSize - 1u) / args.blockSize);
    uint part = (count + GROUP - 1u) / GROUP;
    uint first = min(gl_LocalInvocationIndex * part, count);
    uint last = min(first + part, count);
    uint sum = 0u;
    for (uint i = first; i < last; i++) sum += args.values.at[i];
    totals[gl_LocalInvocationIndex] = sum;
    uint before = args.before != uvec2(0u) ? uintPtr(args.before).at[0] : 0u;
    barrier();

    // What lies before the part, then the sums within it.
    for (uint i = 0u; i < gl_LocalInvocationIndex; i++) before += totals[i];
    for (uint i = first; i < last; i++) {
        uint value = args.values.at[i];
        args.values.at[i] = before;
        before += value;
    }
    if (gl_LocalInvocationIndex < GROUP - 1u) return;
    args.values.at[count] = before;
    if (args.before != uvec2(0u)) uintPtr(args.before).at[0] = before;
}
