// Rays against triangles: (t, weights).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "intersect.glsl"

vec3 hit(TriangleCase x) {
    vec2 weights = vec2(0.0);
    float t = intersectTriangle(makeRay(x.origin, x.direction), x.a, x.b, x.c, weights);
    return vec3(t, weights);
}

MAP(TriangleCase, vec3, hit(x))
