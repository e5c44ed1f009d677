// Adds what the paths of a pixel found, lane by lane, to what the first lane has.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "film_layout.glsl"
#include "labels.glsl"
#include "shared_camera.h"

ARGS(SumLanesArgs)

void main() {
    uint pixel = threadIndex();
    if (pixel >= args.pixels) return;
    [[dont_unroll]] for (uint column = args.firstColumn; column < args.endColumn; column++) {
        if (isLabel(column)) continue;
        uint at = column * args.stride + pixel;
        float sum = args.samples.at[at];
        for (uint lane = 1u; lane < args.lanes; lane++) sum += args.samples.at[at + lane * args.pixels];
        args.samples.at[at] = sum;
    }
    for (uint lane = 1u; lane < args.lanes; lane++)
        joinLabels(args.samples, args.stride, pixel, pixel + lane * args.pixels);
}
