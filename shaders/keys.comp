// The cell key of each photon, and its index, for sorting.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "grid.glsl"
#include "shared_photons.h"

ARGS(KeysArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    args.keys.at[i] =
        cellKey(cellOf(args.photons.at[i].position, args.cellsPerUnit, args.levels), args.levels) & args.cellMask;
    args.values.at[i] = i;
}
