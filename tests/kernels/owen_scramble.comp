// Owen scrambling: (word, seed).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

MAP(uvec2, uint, owenScramble(x.x, x.y))
