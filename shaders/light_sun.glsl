// Suns: cones of directions, of one radiance.
#ifndef LIGHT_SUN_GLSL
#define LIGHT_SUN_GLSL
#include "directions.glsl"
#include "light.glsl"
#include "sampling.glsl"

float solidAngleOfSun(Light light) { return 2.0 * PI * light.u.y; }

// Uniform over the cone.
vec3 sampleSun(Light light, vec2 u) { return toWorld(uniformCone(u, light.u.y), light.a); }

bool isInSun(Light light, vec3 w) {
    vec3 across = cross(w, light.a);
    return dot(w, light.a) > 0.0 && dot(across, across) <= light.u.x * light.u.x;
}

#endif
