// Kernel weights: (kernel, squared distance).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "density.glsl"

MAP(vec2, float, densityWeight(uint(x.x), x.y))
