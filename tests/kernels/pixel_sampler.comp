// Sequences of pixels: (pixel, index, seed, sequence) to (index, seed).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

uvec2 words(Sampler s) { return uvec2(s.index, s.seed); }
MAP(uvec4, uvec2, words(pixelSampler(x.x, x.y, x.z, x.w)))
