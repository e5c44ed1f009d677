// Finds the closest hit of each path in a queue: photons, eye rays and gather rays alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_paths.h"
#include "traverse.glsl"

ARGS(TraceArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    vec3 origin = args.paths.at[slot].origin;
    vec3 direction = args.paths.at[slot].direction;
    uint from = args.paths.at[slot].from;
    if (hasSmoothDiffuse && (args.paths.at[slot].flags & PATH_THROUGH) != 0u)
        origin = beneath(args.scene.at[0], origin, direction, from);
    args.hits.at[slot] = closest(args.scene.at[0], origin, direction, from);
}
