// The sorted spatial hash grid. Its widest cells are a bit more than two of the map's radii wide; each is split into
// eight, `levels` times over. A block is 2 x 2 x 2 of the widest cells: a key is the hash of the block, followed by the
// places of the nested cells, an octant of three bits a level, so that the keys of any cell at any level are
// neighbours.
//
// A disc is looked up at the level whose cells are just wide enough for the eight around its centre to cover it; these
// differ in their last octant, so that none is read twice.
#ifndef GRID_GLSL
#define GRID_GLSL
#include "common.glsl"
#include "hash.h"
#include "random.glsl"
#include "shared_photons.h"

const float FARTHEST_CELL = 5.0e7; // beyond, all cells are one

uint octant(ivec3 cell) {
    uvec3 parity = uvec3(cell & 1);
    return parity.x << 2 | parity.y << 1 | parity.z;
}

// The cell of a point at a level.
ivec3 cellOf(vec3 position, float cellsPerUnit, uint level) {
    return ivec3(floor(clamp(position * cellsPerUnit, -FARTHEST_CELL, FARTHEST_CELL) * float(1u << level)));
}

// The key of a cell at a level, without the octants of the levels below.
uint cellKey(ivec3 cell, uint level) {
    uint key = hash(uvec3(cell >> (level + 1u)));
    for (uint l = 0u; l <= level; l++) key = key << 3 | octant(cell >> (level - l));
    return key;
}

// Cells that cover a disc: with its seven greater neighbours, `first` does.
struct Cells {
    ivec3 first;
    uint level;
    vec3 offset;  // of the disc's centre from the corner where the eight meet, in cells
    float reach2; // square of the radius in cells, with room for rounding
    ivec3 low;    // the disc's bounding box, in cells of half the width
    ivec3 high;
};

// Those of a disc about the normal, a tenth of its radius thick on either side; all those of a ball if the normal is
// zero.
Cells cellsAround(PhotonMap map, vec3 position, vec3 normal, float radius) {
    uint level = 0u;
    for (float wide = 0.5 * map.radius; level < map.levels && radius <= wide; wide *= 0.5) level++;
    float scale = float(1u << level);
    vec3 place = clamp(position * map.cellsPerUnit, -FARTHEST_CELL, FARTHEST_CELL) * scale;
    vec3 first = floor(place - 0.5);
    const float rounding = 0.02;
    vec3 boxRounding = rounding + 2.4e-7 * abs(place); // of the photon's place and of the query's
    float reach = radius * map.cellsPerUnit * scale;
    vec3 extent = reach * (sqrt(max(1.0 - normal * normal, 0.0)) + 0.1 * abs(normal)) + boxRounding;
    return Cells(ivec3(first), level, place - first - 1.0, (reach + rounding) * (reach + rounding),
                 ivec3(floor(2.0 * (place - extent))), ivec3(floor(2.0 * (place + extent))));
}

// The photons of one of the eight cells, as places in the map; none if the disc does not reach it, and not those of the
// first and last eighths that its bounding box leaves out, if the map's cells are split that far.
uvec2 cellRange(PhotonMap map, Cells cells, uint corner) {
    ivec3 side = ivec3(corner >> 2, corner >> 1 & 1u, corner & 1u);
    vec3 away = max(cells.offset * vec3(1 - 2 * side), 0.0);
    ivec3 cell = cells.first + side;
    ivec3 low = max(cells.low - 2 * cell, 0);
    ivec3 high = min(cells.high - 2 * cell, 1);
    if (dot(away, away) > cells.reach2 || any(greaterThan(low, high))) return uvec2(0u);

    uint key = cellKey(cell, cells.level);
    if (cells.level == map.levels) {
        uint only = key & map.cellMask;
        return uvec2(uintPtr(map.cells).at[only], uintPtr(map.cells).at[only + 1u]);
    }
    uint below = 3u * (map.levels - cells.level - 1u);
    uint least = (key << 3 | octant(low)) << below & map.cellMask;
    uint last = (key << 3 | octant(high)) << below & map.cellMask;
    return uvec2(uintPtr(map.cells).at[least], uintPtr(map.cells).at[last + (1u << below)]);
}

#endif
