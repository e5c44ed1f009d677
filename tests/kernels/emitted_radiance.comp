// Radiance that lights send in a direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light.glsl"

MAP(EmittedCase, vec3, emittedRadiance(x.light, x.normal, x.direction))
