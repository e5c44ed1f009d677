// Weights of points of a triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(vec2, vec2, uniformTriangle(x))
