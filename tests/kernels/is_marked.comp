// Whether places are among the marked ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map_args.h"
#include "common.glsl"
#include "visible_cells.glsl"

ARGS(IsMarkedArgs)

void main() {
    uint i = threadIndex();
    if (i < args.count) args.marked.at[i] = uint(isMarked(args.marks, args.photons.at[i].position, args.cellWidth));
}
