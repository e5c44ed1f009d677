// Survival at specular surfaces: (weight, bounce), of photons and what the eye sees, and of gather rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(vec4, vec2, vec2(specularSurvival(x.xyz, uint(x.w), false), specularSurvival(x.xyz, uint(x.w), true)))
