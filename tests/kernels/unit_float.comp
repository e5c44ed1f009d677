// Words as floats in [0, 1).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"

MAP(uint, float, unitFloat(x))
