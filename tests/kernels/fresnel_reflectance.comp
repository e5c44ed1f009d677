// Fresnel reflectance: (eta, cosine).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(vec2, float, fresnel(!hasExactFresnel, x.x, x.y))
