// Adds the sums of a run of passes to those of the run before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "columns.glsl"
#include "pixel_sum.glsl"

ARGS(JoinArgs)

void main() {
    uint pixel = threadIndex();
    if (pixel >= args.pixels) return;
    if (hasNoise != 0u) {
        precise vec3 apart = beautyOf(args.sums, args.pixels, pixel) * args.weights.perPass
            - beautyOf(args.other, args.pixels, pixel) * args.weights.perOtherPass;
        vec3 batch = loadColumns(args.other, args.pixels, COLUMN_COARSE, pixel);
        joinDeviations(args.sums, args.pixels, pixel, apart, batch, args.weights);
    }
    if (hasBias != 0u) args.sums.at[COLUMN_SQUARE * args.pixels + pixel] += args.other.at[COLUMN_SQUARE * args.pixels + pixel];
    for (uint column = 0u; column < SAMPLE_COLUMNS; column++)
        args.sums.at[column * args.pixels + pixel] += args.other.at[column * args.pixels + pixel];
}
