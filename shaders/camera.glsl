// A pinhole camera.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "common.glsl"
#include "shared_scene.h"

// Direction through a film position in [0, 1]^2, y down.
vec3 cameraDirection(Camera camera, vec2 film) {
    return normalize(camera.forward + (2.0 * film.x - 1.0) * camera.right + (1.0 - 2.0 * film.y) * camera.up);
}

// The film position that a direction of any length goes through, which is before the camera; outside of [0, 1]^2 if it
// misses the film.
vec2 filmPosition(Camera camera, vec3 direction) {
    vec2 across = vec2(dot(direction, camera.right), dot(direction, camera.up)) / dot(direction, camera.forward);
    vec2 plane = across / vec2(dot(camera.right, camera.right), dot(camera.up, camera.up));
    return vec2(0.5, 0.5) + vec2(0.5, -0.5) * plane;
}

// Solid angle of a pixel around a direction with this cosine to the camera's axis, by the density of its film positions
// there: its area on the plane at distance 1, times cos^3.
float pixelSolidAngle(Camera camera, uvec2 size, float cosine) {
    float area = 4.0 * length(camera.right) * length(camera.up) / (float(size.x) * float(size.y));
    return area * cosine * cosine * cosine;
}

#endif
