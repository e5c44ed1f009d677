// Radix sort, first step: how often each digit occurs in each block of keys.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_sort.h"

ARGS(SortCountArgs)

const uint DIGITS = 1u << SORT_BITS;
shared uint counts[DIGITS];

void main() {
    for (uint digit = gl_LocalInvocationIndex; digit < DIGITS; digit += GROUP) counts[digit] = 0u;
    barrier();
    uint first = groupIndex() * SORT_BLOCK;
    uint last = min(first + SORT_BLOCK, args.count);
    for (uint i = first + gl_LocalInvocationIndex; i < last; i += GROUP)
        atomicAdd(counts[args.keys.at[i] >> args.shift & DIGITS - 1u], 1u);
    barrier();
    uint blocks = (args.count + SORT_BLOCK - 1u) / SORT_BLOCK;
    if (groupIndex() >= blocks) return;
    for (uint digit = gl_LocalInvocationIndex; digit < DIGITS; digit += GROUP)
        args.sums.at[digit * blocks + groupIndex()] = counts[digit];
}
