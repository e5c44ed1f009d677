// Materials with a diffuse lobe: 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "offset.glsl"
#include "sphere.glsl"
#include "surface.glsl"
#include "material.glsl"

MAP(Material, uint, uint(isDiffuse(x)))
