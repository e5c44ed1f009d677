// Film positions by way of a point of the lens and a direction from it: those they came from.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "lens.glsl"

vec2 seenAgain(Camera camera, vec2 film) {
    vec3 offset = lensPoint(camera, fract(film * vec2(7.0, 13.0)));
    return filmPosition(camera, throughLens(camera, offset, 3.0 * lensDirection(camera, offset, film)));
}

MAP(CameraCase, vec2, seenAgain(x.camera, x.film))
