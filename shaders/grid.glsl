// The sorted spatial hash grid: keys of cells. A cell is a bit more than two gather radii wide, so that the eight
// cells around a point cover its disc; in a block of 2 x 2 x 2 cells all keys differ, so none is read twice.

ivec3 cellOf(vec3 position, float cellsPerUnit) {
    return ivec3(clamp(floor(position * cellsPerUnit), -1.0e9, 1.0e9));
}

uint cellKey(ivec3 cell, uint mask) {
    uvec3 block = uvec3(cell >> 1);
    uvec3 parity = uvec3(cell & 1);
    uint h = hash(block.x ^ hash(block.y ^ hash(block.z)));
    return (h << 3 | parity.x << 2 | parity.y << 1 | parity.z) & mask;
}

// The cell that, with its seven greater neighbours, covers the disc about a point.
ivec3 firstCell(vec3 position, float cellsPerUnit) {
    return ivec3(clamp(floor(position * cellsPerUnit - 0.5), -1.0e9, 1.0e9));
}

uvec2 cellRange(PhotonMap map, ivec3 first, uint corner) {
    uint key = cellKey(first + ivec3(corner >> 2, corner >> 1 & 1u, corner & 1u), map.cellMask);
    return uvec2(map.cells.at[key], map.cells.at[key + 1u]);
}
