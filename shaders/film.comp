// Takes one pass into the sums of a run. A sample that is not finite is counted, and black.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "pixel_sum.glsl"

ARGS(FilmArgs)

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    Sample s = args.samples.at[slot];
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        if (isFinite(s.layers[layer])) continue;
        atomicAdd(args.status.at[0].nonfinite[layer], 1u);
        s.layers[layer] = vec3(0.0);
    }
    uint pixel = args.firstPixel + slot;
    args.sums.at[pixel] = join(args.sums.at[pixel], PixelSum(s, vec3(0.0)), args.perPass, 1.0, args.weight);
}
