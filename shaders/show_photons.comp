// Shows the photons within a pixel's width of each point asked for, in their colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "density.glsl"
#include "film_layout.glsl"
#include "grid.glsl"
#include "shared_camera.h"
#include "shared_paths.h"
#include "shared_photons.h"

ARGS(GatherArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    Query query = args.queries.at[slot];
    float radius = min(1.5 * query.footprint, args.map.radius);
    vec3 sum = vec3(0.0);
    Cells cells = cellsAround(args.map, query.position, query.normal, radius);
    for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(args.map, cells, corner);
        for (uint i = range.x; i < range.y; i++) {
            if (photonDistance2(args.map, i, query, radius) < GREATEST) sum += PhotonPtr(args.map.photons).at[i].color;
        }
    }
    float brightest = maxComponent(sum);
    if (brightest > 0.0) addToColumns(args.samples, args.stride, query.column, slot, sum / brightest);
}
