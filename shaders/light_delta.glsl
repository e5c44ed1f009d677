// Lights without a size: points, and spots.
#ifndef LIGHT_DELTA_GLSL
#define LIGHT_DELTA_GLSL
#include "light.glsl"
#include "light_kinds.glsl"

bool isDelta(Light light) { return hasDeltaLights && (DELTA_LIGHT_KINDS >> light.kind & 1u) != 0u; }

bool isSpot(Light light) { return hasSpots && light.kind == LIGHT_SPOT; }

// One minus the cosine between two directions that may be close to each other.
float heightBetween(vec3 a, vec3 b) { return 0.5 * dot(a - b, a - b); }

// The part of its intensity that a light sends in a direction: of a spot, the square of a line that is 1 in the inner
// cone and 0 at the outer one, in the cosine (glTF, KHR_lights_punctual). v.x is 1 - cosine of the outer one, v.y one
// over what it has more than the inner one.
float beam(Light light, vec3 w) {
    if (!isSpot(light)) return 1.0;
    float part = clamp((light.v.x - heightBetween(w, light.u)) * light.v.y, 0.0, 1.0);
    return part * part;
}

#endif
