// The second dimension of the Sobol sequence.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

MAP(uint, uint, sobolSecond(x))
