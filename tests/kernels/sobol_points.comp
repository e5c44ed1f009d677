// Points of sequences: (index, seed, dimension).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

MAP(uvec3, vec2, sample2(Sampler(x.x, x.y), x.z))
