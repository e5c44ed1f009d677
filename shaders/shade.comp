// A bounce of eye paths: see shade.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compaction.glsl"
#include "shade.glsl"

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;
    uint slot = args.list.at[queue.first + place];
    Vertex vertex = shade(slot, args.bounce, args.paths.at[slot], args.hits.at[slot]);
    putFlags(args.flags, place, EYE_QUEUES, vertex.queues);
    if (vertex.emissionColumn != NONE)
        addToColumns(args.samples, args.stride, vertex.emissionColumn, slot, vertex.emission);
    if ((vertex.queues & 1u << QUEUE_CONTINUE) != 0u) args.paths.at[slot] = vertex.path;
    if ((vertex.queues & 1u << QUEUE_SHADOW) != 0u) args.shadowRays.at[slot] = vertex.shadowRay;
    if ((vertex.queues & (1u << QUEUE_CAUSTIC | 1u << QUEUE_GLOBAL)) != 0u) args.queries.at[slot] = vertex.query;
    if (vertex.split.flags != NONE) args.splits.at[slot] = vertex.split;
}
