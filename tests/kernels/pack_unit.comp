// Unit vectors in 32 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "directions.glsl"

MAP(vec3, uint, packUnit(x))
