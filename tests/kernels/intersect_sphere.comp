// Rays against spheres.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "intersect.glsl"

MAP(SphereCase, float, intersectSphere(makeRay(x.origin, x.direction), x.center, x.radius, x.pole))
