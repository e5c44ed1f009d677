// Sequences of photons: (photon, pass, seed, map) to (index, seed).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

uvec2 words(Sampler s) { return uvec2(s.index, s.seed); }
MAP(uvec4, uvec2, words(photonSampler(x.x, x.y, x.z, x.w)))
