// Which photons stay in a map whose crowded cells are thinned.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "crowd.glsl"
#include "shared_photons.h"

ARGS(CrowdArgs)

void main() {
    uint i = threadIndex();
    if (i < args.count) args.stays.at[i] = min(weightAfterThinning(args.keys, args.cells, i, args.pass), 1u);
}
