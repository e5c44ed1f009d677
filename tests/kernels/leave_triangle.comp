// Rays that leave a triangle, against that triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "intersect.glsl"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"

Leaving again(LeavingCase x) {
    Surface surface = triangleSurface(args.scene.at[0], x.primitive, Hit(0.0, 0u, x.weights));
    vec3 origin = leave(surface, x.direction);
    vec2 weights;
    Primitive p = x.primitive;
    return Leaving(origin, surface.normal, intersectTriangle(makeRay(origin, x.direction), p.a, p.b, p.c, weights));
}

MAP(LeavingCase, Leaving, again(x))
