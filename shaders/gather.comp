// Adds what the photon map estimates at each point asked for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "random.glsl"
#include "frame.glsl"
#include "grid.glsl"
#include "radius_field.glsl"
#include "density.glsl"
#include "columns.glsl"

ARGS(GatherArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    Query query = args.queries.at[slot];
    float radius = hasNearest != 0u && args.map.nearest > 0u ? nearestRadius(args.map, query, args.map.nearest) * args.map.shrink
                                                            : radiusAt(args.map, query.position);
    vec3 irradiance = estimateWithin(args.map, query, radius) * args.map.photonFlux;
    addToColumns(args.samples, args.stride, query.column, slot, query.weight * irradiance);
}
