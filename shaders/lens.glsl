// The lens of a camera: a disc; what lies in the plane of focus is sharp.
#ifndef LENS_GLSL
#define LENS_GLSL
#include "camera.glsl"
#include "common.glsl"
#include "sampling.glsl"
#include "shared_scene.h"

const uint LENS_DIMENSION = 0x6c656e73u; // of sequences: no bounce has it

// A point of the lens, uniform over its area, from its middle.
vec3 lensPoint(Camera camera, vec2 u) {
    vec2 p = camera.aperture * uniformDisc(u);
    return p.x * normalize(camera.right) + p.y * normalize(camera.up);
}

// The direction from a point of the lens to what is in focus at a film position.
vec3 lensDirection(Camera camera, vec3 offset, vec2 film) {
    vec3 sharp = camera.forward + (2.0 * film.x - 1.0) * camera.right + (1.0 - 2.0 * film.y) * camera.up;
    return normalize(camera.focus * sharp - offset);
}

// What the middle of the lens would see at the film position that a direction from a point of it goes through: where it
// crosses the plane of focus.
vec3 throughLens(Camera camera, vec3 offset, vec3 direction) {
    return offset + direction * (camera.focus / dot(direction, camera.forward));
}

#endif
