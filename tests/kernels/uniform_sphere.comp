// Directions of the sphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(vec2, vec3, uniformSphere(x))
