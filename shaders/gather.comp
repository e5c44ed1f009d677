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
    vec3 radiance, bias;
    if (!gather(args.map, query, radiance, bias)) return;
    if (hasBias) addToColumns(args.samples, args.stride, COLUMN_BIAS, slot, bias);
    addToColumns(args.samples, args.stride, query.column, slot, radiance);
    if (args.map.partial != 0u) args.queries.at[slot].column = NONE;
}
