// Turns the film's beauty into 8-bit sRGB colours (IEC 61966-2-1) under an exposure.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(DevelopArgs)

vec3 encodeSrgb(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    vec3 beauty = vec3(0.0);
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) beauty += args.sums.at[i].sum.layers[layer];
    uvec3 c = uvec3(round(255.0 * encodeSrgb(beauty * args.exposure)));
    args.colors.at[i] = c.x | c.y << 8 | c.z << 16 | 0xff000000u;
}
