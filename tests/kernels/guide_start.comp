// Warps the numbers of starts by a guide.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "../map_args.h"
#include "guide.glsl"
#include "shared_photons.h"

ARGS(GuideStartArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    float numbers[START_NUMBERS] = args.starts.at[i].numbers;
    args.starts.at[i].sparse = guide(GuideNodePtr(args.guide), numbers);
    args.starts.at[i].numbers = numbers;
}
