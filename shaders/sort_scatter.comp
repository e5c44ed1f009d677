// Radix sort, last step: moves each key and value to its place; stable. A group takes 64 pairs at a time: who has a
// digit is a mask of 64 bits, and the rank among equal digits is the number of bits below one's own.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_sort.h"

ARGS(SortScatterArgs)

const uint DIGITS = 1u << SORT_BITS;
shared uint places[DIGITS]; // of the next pair with that digit
shared uint low[DIGITS];
shared uint high[DIGITS];

void main() {
    uint index = gl_LocalInvocationIndex;
    uint blocks = (args.count + SORT_BLOCK - 1u) / SORT_BLOCK;
    bool real = groupIndex() < blocks;
    for (uint digit = index; digit < DIGITS; digit += GROUP) {
        places[digit] = real ? args.sums.at[digit * blocks + groupIndex()] : 0u;
        low[digit] = 0u;
        high[digit] = 0u;
    }
    barrier();

    uvec2 bit = index < 32u ? uvec2(1u << index, 0u) : uvec2(0u, 1u << (index - 32u));
    uvec2 below = index < 32u ? uvec2(bit.x - 1u, 0u) : uvec2(0xffffffffu, bit.y - 1u);
    uint first = groupIndex() * SORT_BLOCK;
    uint last = real ? min(first + SORT_BLOCK, args.count) : first;
    for (uint start = first; start < last; start += GROUP) {
        uint i = start + index;
        bool mine = i < last;
        uint key = mine ? args.keys.at[i] : 0u;
        uint digit = key >> args.shift & DIGITS - 1u;
        if (mine) {
            if (bit.x != 0u) atomicOr(low[digit], bit.x);
            else atomicOr(high[digit], bit.y);
        }
        barrier();
        uvec2 mask = uvec2(low[digit], high[digit]);
        uint rank = bitCount(mask.x & below.x) + bitCount(mask.y & below.y);
        uint place = places[digit] + rank;
        if (mine) {
            args.sortedKeys.at[place] = key;
            args.sortedValues.at[place] = args.values.at[i];
        }
        barrier();
        // The first of each digit moves its place on and clears the mask.
        if (mine && rank == 0u) {
            places[digit] = place + bitCount(mask.x) + bitCount(mask.y);
            low[digit] = 0u;
            high[digit] = 0u;
        }
        barrier();
    }
}
