// Luminance of colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"

MAP(vec3, float, luminance(x))
