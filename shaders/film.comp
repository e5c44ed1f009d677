// Takes one pass into the running means of the pixels, and the squared deviations of beauty (Welford 1962).
// A sample that is not finite is counted and left out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(FilmArgs)

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    Sample s = args.samples.at[slot];
    Pixel pixel = args.pixels.at[args.firstPixel + slot];
    float part = 1.0 / float(args.passes + 1u);

    vec3 before = vec3(0.0);
    vec3 beauty = vec3(0.0);
    vec3 after = vec3(0.0);
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        vec3 mean = pixel.mean.layers[layer];
        vec3 value = s.layers[layer];
        if (!isFinite(value)) {
            atomicAdd(args.status.at[0].nonfinite[layer], 1u);
            value = mean;
        }
        before += mean;
        beauty += value;
        pixel.mean.layers[layer] = mean + (value - mean) * part;
        after += pixel.mean.layers[layer];
    }
    pixel.deviation += (beauty - before) * (beauty - after);
    pixel.mean.albedo += (s.albedo - pixel.mean.albedo) * part;
    pixel.mean.normal += (s.normal - pixel.mean.normal) * part;
    pixel.mean.depth += (s.depth - pixel.mean.depth) * part;
    pixel.mean.covered += (s.covered - pixel.mean.covered) * part;
    args.pixels.at[args.firstPixel + slot] = pixel;
}
