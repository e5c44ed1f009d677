// Origins of rays that leave a surface.
#ifndef OFFSET_GLSL
#define OFFSET_GLSL
#include "common.glsl"

// How far off its surface a point may be along n: about 64 roundings of the numbers it came from.
float roundingAlong(vec3 magnitude, vec3 n) {
    const float roundings = 3.8146973e-6; // 2^-18
    return roundings * dot(abs(n), magnitude);
}

// A point moved off its surface to the side of n, by about 64 roundings of the numbers it came from:
// in ulps like Waechter & Binder (2019), but without their absolute part, so that a scene scaled by a
// power of two keeps its bits. Rays leave out the triangle they start on; the offset keeps them from slipping through
// its neighbours, and from hitting their own sphere again.
vec3 offsetPoint(vec3 position, vec3 magnitude, vec3 n) { return position + n * roundingAlong(magnitude, n); }

#endif
