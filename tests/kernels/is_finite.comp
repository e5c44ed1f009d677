// Vectors without infinities and NaN: 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"

MAP(vec3, uint, uint(isFinite(x)))
