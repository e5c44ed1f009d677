// Where each key starts among the sorted keys: each photon writes the starts of the keys from its predecessor's to its
// own. And whether any key has too many.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_photons.h"

ARGS(CellsArgs)

void main() {
    uint i = threadIndex();
    if (i > args.count) return;
    uint first = i == 0u ? 0u : args.keys.at[i - 1u] + 1u;
    uint last = i == args.count ? args.cellMask + 1u : args.keys.at[i];
    if (i + MAX_PHOTONS_PER_CELL < args.count && args.keys.at[i] == args.keys.at[i + MAX_PHOTONS_PER_CELL])
        args.overfull.at[0] = 1u;
    for (uint key = first; key <= last; key++) args.cells.at[key] = i;
}
