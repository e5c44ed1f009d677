// Rays that leave a sphere, against that sphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "intersect.glsl"
#include "shared_paths.h"
#include "surface.glsl"

Leaving again(LeavingCase x) {
    Surface surface = sphereSurface(x.primitive, x.along, Hit(0.0, 0u, vec2(0.0)));
    vec3 origin = leave(surface, x.direction);
    return Leaving(origin, surface.normal,
                   intersectSphere(makeRay(origin, x.direction), x.primitive.a, x.primitive.b.x, x.primitive.c));
}

MAP(LeavingCase, Leaving, again(x))
