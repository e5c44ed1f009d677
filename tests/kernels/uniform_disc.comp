// Points of the unit disc.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(vec2, vec2, uniformDisc(x))
