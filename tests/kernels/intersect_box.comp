// Rays against boxes, without an end.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "intersect.glsl"

MAP(BoxCase, float, intersectBox(makeRay(x.origin, x.direction), x.low, x.high, GREATEST))
