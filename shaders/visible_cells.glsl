// A set of cells of several widths, where the eye looks: bits by hash, so that few cells that were not marked seem to
// be. Cells of level l are 2^l times as wide as the finest.
#ifndef VISIBLE_CELLS_GLSL
#define VISIBLE_CELLS_GLSL
#include "common.glsl"
#include "hash.h"
#include "random.glsl"
#include "shared_guide.h"

uint markHash(ivec3 cell, uint level) { return hash(uvec3(cell) ^ uvec3(0u, 0u, hash(level))); }

ivec3 markedCell(vec3 position, float width) { return ivec3(floor(clamp(position / width, -1.0e9, 1.0e9))); }

// Marks the eight cells of a level about a position: all within half a cell's width of it.
void mark(uintPtr marks, vec3 position, float finest, uint level) {
    float width = ldexp(finest, int(level));
    ivec3 first = markedCell(position - 0.5 * width, width);
    for (uint corner = 0u; corner < 8u; corner++) {
        uint bit = markHash(first + ivec3(corner >> 2, corner >> 1 & 1u, corner & 1u), level);
        atomicOr(marks.at[(bit >> 5) % VISIBLE_CELL_WORDS], 1u << (bit & 31u));
    }
    atomicOr(marks.at[VISIBLE_CELL_WORDS], 1u << level);
}

bool isMarked(uintPtr marks, vec3 position, float finest) {
    for (uint levels = marks.at[VISIBLE_CELL_WORDS]; levels != 0u; levels &= levels - 1u) {
        uint level = uint(findLSB(levels));
        uint bit = markHash(markedCell(position, ldexp(finest, int(level))), level);
        if ((marks.at[(bit >> 5) % VISIBLE_CELL_WORDS] >> (bit & 31u) & 1u) != 0u) return true;
    }
    return false;
}

#endif
