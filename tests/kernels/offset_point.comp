// Points moved off their surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "offset.glsl"

MAP(OffsetCase, vec3, offsetPoint(x.position, x.magnitude, x.normal))
