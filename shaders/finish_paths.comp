// Takes the last paths from the eye to their ends in one dispatch, each in a loop of its own with its shadow rays and
// gathers: they are too few for eight dispatches a bounce. One that has not ended after as many bounces as a dispatch
// may take stays under way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compaction.glsl"
#include "gather.glsl"
#include "shade.glsl"
#include "trace_path.glsl"

// Asks the maps: those of narrow discs, then that of caustics; or the global one.
bool gatherFrom(uint queues, Query query, out vec3 radiance, out vec3 bias) {
    CameraPass pass = args.pass.at[0];
    bool global = (queues & 1u << QUEUE_GLOBAL) != 0u;
    uint end = global ? pass.narrow + 2u : pass.narrow + 1u;
    for (uint i = global ? pass.narrow + 1u : 0u; i < end; i++) {
        PhotonMap map = PhotonMapPtr(pass.maps).at[i];
        if (map.radius > 0.0 && gather(map, query, radiance, bias)) return true;
    }
    return false;
}

// Adds what a path finds at a vertex, in the order of the kernels that it would have gone through. One place in the
// code adds all of it, as each costs a compiler much.
void addContributions(uint slot, Vertex vertex) {
    uint columns[4] = uint[4](vertex.emissionColumn, NONE, NONE, NONE);
    vec3 values[4] = vec3[4](vertex.emission, vertex.shadowRay.radiance, vec3(0.0), vec3(0.0));
    if ((vertex.queues & 1u << QUEUE_SHADOW) != 0u && !hidden(args.scene.at[0], vertex.shadowRay))
        columns[1] = vertex.shadowRay.column;
    if ((hasCausticMap || hasGlobalMap) && (vertex.queues & (1u << QUEUE_CAUSTIC | 1u << QUEUE_GLOBAL)) != 0u &&
        gatherFrom(vertex.queues, vertex.query, values[3], values[2])) {
        if (hasBias) columns[2] = COLUMN_BIAS;
        columns[3] = vertex.query.column;
    }
    [[dont_unroll]] for (uint i = 0u; i < 4u; i++) {
        uint column = i == 0u ? columns[0] : i == 1u ? columns[1] : i == 2u ? columns[2] : columns[3];
        vec3 value = i == 0u ? values[0] : i == 1u ? values[1] : i == 2u ? values[2] : values[3];
        if (column != NONE) addToColumns(args.samples, args.stride, column, slot, value);
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
        shadowRays += queues >> QUEUE_SHADOW & 1u;
        addContributions(slot, vertex);
        if (vertex.split.flags != NONE) args.splits.at[slot] = vertex.split;
    }
    putFlags(args.flags, place, 1u, queues & 1u << QUEUE_CONTINUE);
    atomicAdd(args.status.at[0].paths, rays);
    atomicAdd(args.status.at[0].shadowRays, shadowRays);
    if ((queues & 1u << QUEUE_CONTINUE) == 0u) return;
    args.paths.at[slot] = path;
    atomicAdd(args.status.at[0].unfinished, 1u);
}
