// Warps the numbers of starts by a guide.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map_args.h"
#include "common.glsl"
#include "guide.glsl"
#include "shared_photons.h"

ARGS(GuideStartArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    float numbers[PRIMARY_DIMENSIONS] = args.starts.at[i].numbers;
    args.starts.at[i].inverseDensity = guide(GuideNodePtr(args.guide), numbers);
    args.starts.at[i].numbers = numbers;
}
