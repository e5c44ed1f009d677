// The greatest component of vectors.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"

MAP(vec3, float, maxComponent(x))
