// Survival at specular surfaces: (weight, bounce), where no lamp may be seen, and where one may.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(vec4, vec2, vec2(specularSurvival(x.xyz, uint(x.w), false), specularSurvival(x.xyz, uint(x.w), true)))
