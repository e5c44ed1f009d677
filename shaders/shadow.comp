// Adds each light sample that nothing hides.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "film_layout.glsl"
#include "labels.glsl"
#include "shared_camera.h"
#include "shared_paths.h"
#include "traverse.glsl"

ARGS(ShadowArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    ShadowRay ray = args.shadowRays.at[slot];
    if (hidden(args.scene.at[0], ray)) return;
    addToColumns(args.samples, args.stride, ray.column, slot, ray.radiance);
    labelLight(args.samples, args.stride, slot, ray.column, ray.radiance, FOUND_BY_SAMPLE);
}
