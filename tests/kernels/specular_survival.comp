// Survival at specular surfaces: (weight, bounce).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(vec4, float, specularSurvival(x.xyz, uint(x.w)))
