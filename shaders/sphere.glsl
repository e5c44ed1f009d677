// The one measure of spheres that rays and surfaces share.
#ifndef SPHERE_GLSL
#define SPHERE_GLSL
#include "common.glsl"

// A point's squared distance from a sphere's centre less the squared radius, from the sphere's point next to the origin
// of coordinates: for large spheres, whose centres are far away, centre and radius alone would leave no digits.
float spherePower(vec3 point, vec3 center, vec3 pole) {
    vec3 d = point - pole;
    return dot(d, d + 2.0 * (pole - center));
}

#endif
