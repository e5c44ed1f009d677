// Fresnel reflectance: (eta, cosine).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "offset.glsl"
#include "sphere.glsl"
#include "surface.glsl"
#include "material.glsl"

MAP(vec2, float, fresnel(hasExactFresnel == 0u, x.x, x.y))
