// Marks where camera paths would ask a photon map: what a gather reads, and what lies between it and the next path's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "radius_field.glsl"
#include "shared_camera.h"
#include "shared_guide.h"
#include "shared_paths.h"
#include "visible_cells.glsl"

ARGS(MarkVisibleArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    Query query = args.queries.at[slot];
    if (query.column == NONE) return;
    float radius = radiusAt(args.map, query.position);
    if (radius == 0.0) return;
    if (args.map.partial != 0u) args.queries.at[slot].column = NONE;
    float reach = max(radius, args.reach * query.footprint);
    uint level = 0u;
    while (level < 31u && ldexp(args.cellWidth, int(level)) < 2.0 * reach) level++;
    mark(args.marks, query.position, args.cellWidth, level);
}
