// Adds the sums of a run of passes to those of the run before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "pixel_sum.glsl"

ARGS(JoinArgs)

void main() {
    uint pixel = threadIndex();
    if (pixel < args.count)
        args.sums.at[pixel] = join(args.sums.at[pixel], args.other.at[pixel], args.perPass, args.perOtherPass, args.weight);
}
