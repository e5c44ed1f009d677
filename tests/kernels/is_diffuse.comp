// Materials with a diffuse lobe: 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"
#include "shared_scene.h"

MAP(Material, uint, uint(isDiffuse(x)))
