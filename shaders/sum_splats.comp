// Adds up what photons add to each pixel, in the order of the photons.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "film_layout.glsl"
#include "shared_film.h"
#include "shared_splat.h"

ARGS(SumSplatsArgs)

// The first of the sorted splats that is not of a pixel before this one.
uint firstOf(uint pixel) {
    uint low = 0u;
    uint high = args.splatCount;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (args.pixels.at[middle] < pixel) low = middle + 1u;
        else high = middle;
    }
    return low;
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    uint pixel = args.firstPixel + slot;
    precise vec3 sum = vec3(0.0);
    for (uint i = firstOf(pixel); i < args.splatCount && args.pixels.at[i] == pixel; i++)
        sum += args.splats.at[args.order.at[i]].radiance;
    storeColumns(args.samples, args.stride, COLUMN_CAUSTIC, slot, sum);
}
