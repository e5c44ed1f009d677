// Starts a path for each pixel at the camera, on its lens if it has one, at a place within the pixel that differs from
// path to path (box filter).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera.glsl"
#include "common.glsl"
#include "labels.glsl"
#include "lanes.glsl"
#include "lens.glsl"
#include "random.glsl"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_paths.h"
#include "shared_scene.h"

ARGS(EyeArgs)

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    uint pixel = args.of.firstPixel + pixelOfSlot(args.of, slot);
    vec2 within = args.centered != 0u ? vec2(0.5) : sample2(eyeSampler(args.of, slot, SAMPLES_EYE), 0u);
    vec2 film = (vec2(pixel % args.size.x, pixel / args.size.x) + within) / vec2(args.size);
    Camera camera = args.scene.at[0].camera;
    uint media = hasMedia ? args.scene.at[0].cameraMedia : 0u;
    vec3 origin = camera.origin, direction = cameraDirection(camera, film);
    if (hasLens && camera.aperture > 0.0) {
        vec3 offset = lensPoint(camera, sample2(eyeSampler(args.of, slot, SAMPLES_EYE), LENS_DIMENSION));
        origin += offset;
        direction = lensDirection(camera, offset, film);
    }
    args.paths.at[slot] = Path(origin, direction, vec3(shareOfEach(args.of)), 0.0, NONE, 0u, media);
    args.list.at[slot] = slot;
    if (args.splitting != 0u) args.splits.at[slot].flags = NONE;
    forgetEvents(args.samples, args.stride, slot);
}
