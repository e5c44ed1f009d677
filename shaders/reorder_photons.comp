// Copies the photons into the order of their sorted keys.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_photons.h"

ARGS(ReorderPhotonsArgs)

void main() {
    uint i = threadIndex();
    if (i < args.count) args.arranged.at[i] = args.photons.at[args.order.at[i]];
}
