// A pinhole camera.

// Direction through a film position in [0, 1]^2, y down.
vec3 cameraDirection(Camera camera, vec2 film) {
    return normalize(camera.forward + (2.0 * film.x - 1.0) * camera.right + (1.0 - 2.0 * film.y) * camera.up);
}
