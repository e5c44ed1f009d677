// Kernel weights: (kernel, squared distance).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"
#include "frame.glsl"
#include "grid.glsl"
#include "density.glsl"

MAP(vec2, float, densityWeight(uint(x.x), x.y))
