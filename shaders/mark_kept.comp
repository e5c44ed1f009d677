// Which photons stay in a map whose overfull cells are thinned.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "cell_thinning.glsl"
#include "common.glsl"
#include "shared_photons.h"

ARGS(MarkKeptArgs)

void main() {
    uint i = threadIndex();
    if (i < args.count) args.kept.at[i] = min(weightAfterThinning(args.keys, args.cells, i, args.pass), 1u);
}
