// Takes the last paths from the eye to their ends in one dispatch, each in a loop of its own with its shadow rays and
// gathers: they are too few for eight dispatches a bounce. One that has not ended after as many bounces as a dispatch
// may take stays under way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather.glsl"
#include "shade.glsl"
#include "trace_path.glsl"

// Adds what a path asks of the maps: first of those of narrow discs, then of that of caustics, or of the global one.
void addGathered(uint slot, uint queues, Query query) {
    CameraPass pass = args.pass.at[0];
    bool global = (queues & 1u << QUEUE_GLOBAL) != 0u;
    for (uint i = global ? pass.narrow + 1u : 0u; i < pass.narrow + (global ? 2u : 1u) && query.column != NONE; i++) {
        PhotonMap map = PhotonMapPtr(pass.maps).at[i];
        if (map.radius > 0.0) gather(map, query, args.samples, args.stride, slot);
    }
}

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;

    uint slot = args.list.at[queue.first + place];
    Path path = args.paths.at[slot];
    uint queues = 1u << QUEUE_CONTINUE, rays = 0u, shadowRays = 0u;
    uint most = min(FINISH_BOUNCES, MAX_BOUNCES - args.bounce);
    while ((queues & 1u << QUEUE_CONTINUE) != 0u && rays < most) {
        Vertex vertex = shade(slot, args.bounce + rays, path, tracePath(args.scene.at[0], path), false);
        queues = vertex.queues;
        path = vertex.path;
        rays++;
        if (vertex.emissionColumn != NONE)
            addToColumns(args.samples, args.stride, vertex.emissionColumn, slot, vertex.emission);
        if ((queues & 1u << QUEUE_SHADOW) != 0u) {
            ShadowRay ray = vertex.shadowRay;
            if (!hidden(args.scene.at[0], ray)) addToColumns(args.samples, args.stride, ray.column, slot, ray.radiance);
            shadowRays++;
        }
        if ((hasCausticMap || hasGlobalMap) && (queues & (1u << QUEUE_CAUSTIC | 1u << QUEUE_GLOBAL)) != 0u)
            addGathered(slot, queues, vertex.query);
        if (vertex.split.flags != NONE) args.splits.at[slot] = vertex.split;
    }
    args.flags.at[place] = queues & 1u << QUEUE_CONTINUE;
    atomicAdd(args.status.at[0].paths, rays);
    atomicAdd(args.status.at[0].shadowRays, shadowRays);
    if ((queues & 1u << QUEUE_CONTINUE) == 0u) return;
    args.paths.at[slot] = path;
    atomicAdd(args.status.at[0].unfinished, 1u);
}
