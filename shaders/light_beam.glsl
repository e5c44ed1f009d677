// Beams: of spots, and of balls that shine like spots.
#ifndef LIGHT_BEAM_GLSL
#define LIGHT_BEAM_GLSL
#include "light_kinds.glsl"
#include "shared_scene.h"

// The outer cone of a beam: 1 - cosine of half its angle, and one over what that has more than the inner cone's.
struct Beam {
    vec3 axis;
    float height;
    float slope;
};

// Spheres with a v have a beam, along v.
bool isBeam(Light light) {
    return hasSpots && (light.kind == LIGHT_SPOT || (light.kind == LIGHT_SPHERE && light.v != vec3(0.0)));
}

Beam beamOf(Light light) {
    if (light.kind == LIGHT_SPHERE) return Beam(light.v, light.u.y, light.u.z);
    return Beam(light.u, light.v.x, light.v.y);
}

// The part of its radiance or intensity that a light sends in a direction: the square of a line that is 1 in the inner
// cone and 0 at the outer one, in the cosine (glTF, KHR_lights_punctual).
float partOfBeam(Light light, vec3 w) {
    if (!isBeam(light)) return 1.0;
    Beam beam = beamOf(light);
    float height = 0.5 * dot(w - beam.axis, w - beam.axis); // 1 - cosine, of directions that may be close to each other
    float part = clamp((beam.height - height) * beam.slope, 0.0, 1.0);
    return part * part;
}

#endif
