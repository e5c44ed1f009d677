// Points of the unit circle from turns.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(float, vec2, unitCircle(x))
