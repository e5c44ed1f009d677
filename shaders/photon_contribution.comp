// Counts the photons of each path, and those that came to lie where the eye looks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_guide.h"
#include "visible_cells.glsl"

ARGS(PhotonContributionArgs)

void main() {
    uint path = threadIndex();
    if (path >= args.count) return;
    uint seen = 0u;
    uint first = args.offsets.at[path];
    uint end = args.offsets.at[path + 1u];
    for (uint i = first; i < end; i++) {
        vec3 position = args.photons.at[i].position;
        if (!isMarked(args.marks, position, args.cellWidth)) continue;
        if (seen++ == 0u) args.starts.at[path].place = position;
    }
    args.starts.at[path].seen = seen;
    args.starts.at[path].stored = end - first;
}
