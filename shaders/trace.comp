// Finds the closest hit of each path in a queue: photons, eye rays and gather rays alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_paths.h"
#include "trace_path.glsl"

ARGS(TraceArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    args.hits.at[slot] = tracePath(args.scene.at[0], args.paths.at[slot]);
}
