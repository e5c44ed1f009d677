// 1 - cos of the half angle of a sphere: (radius, squared distance).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(vec2, float, coneHeight(x.x, x.y))
