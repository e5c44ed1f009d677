// Adds the sums of a run of passes to those of the run before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "accumulate.glsl"
#include "common.glsl"
#include "film_layout.glsl"
#include "shared_film.h"

ARGS(JoinArgs)

void main() {
    uint pixel = threadIndex();
    if (pixel >= args.pixels) return;
    if (hasNoise)
        joinBeauty(args.sums, args.pixels, pixel, args.other, args.pixels, pixel,
                   loadColumns(args.other, args.pixels, COLUMN_COMPENSATION, pixel),
                   loadColumns(args.other, args.pixels, COLUMN_LARGE_BATCHES, pixel), args.weights);
    if (hasBias)
        args.sums.at[COLUMN_SQUARE * args.pixels + pixel] += args.other.at[COLUMN_SQUARE * args.pixels + pixel];
    [[dont_unroll]] for (uint column = 0u; column < SAMPLE_COLUMNS; column++)
        args.sums.at[column * args.pixels + pixel] += args.other.at[column * args.pixels + pixel];
}
