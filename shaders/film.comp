// Takes one pass into the sums of a run. A sample that is not finite is counted, and black.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "accumulate.glsl"
#include "common.glsl"
#include "film_layout.glsl"
#include "shared_film.h"
#include "shared_layers.h"

ARGS(FilmArgs)

void blacken(uint slot) {
    [[dont_unroll]] for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        if (!hasLayer(layer) || isFinite(loadColumns(args.samples, args.stride, layerColumn(layer), slot))) continue;
        atomicAdd(args.status.at[0].nonfinite[layer], 1u);
        storeColumns(args.samples, args.stride, layerColumn(layer), slot, vec3(0.0));
    }
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    if (args.unfinished != uvec2(0u) && uintPtr(args.unfinished).at[0] != 0u) return;
    uint pixel = args.firstPixel + slot;
    blacken(slot);
    if (hasNoise)
        joinBeauty(args.sums, args.pixels, pixel, args.samples, args.stride, slot, vec3(0.0), vec3(0.0), args.weights);
    if (hasBias) {
        precise float bias = luminance(loadColumns(args.samples, args.stride, COLUMN_BIAS, slot));
        precise float square = bias * bias;
        args.sums.at[COLUMN_SQUARE * args.pixels + pixel] += square;
    }
    [[dont_unroll]] for (uint column = 0u; column < SAMPLE_COLUMNS; column++)
        args.sums.at[column * args.pixels + pixel] += args.samples.at[column * args.stride + slot];
}
