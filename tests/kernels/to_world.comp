// Vectors turned to be about a normal: (vector, normal).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "directions.glsl"

MAP(VectorPair, vec3, toWorld(x.a, x.b))
