// Directions within a cone: (u, height).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"

MAP(vec3, vec3, uniformCone(x.xy, x.z))
