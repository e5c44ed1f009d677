// Answers the queries of a queue: see gather.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather.glsl"
#include "shared_paths.h"

ARGS(GatherArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    Query query = args.queries.at[slot];
    if (query.column == NONE) return;
    gather(args.map, query, args.samples, args.stride, slot);
    if (args.map.partial != 0u) args.queries.at[slot].column = query.column;
}
