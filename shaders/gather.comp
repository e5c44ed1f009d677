// Adds what the photon map estimates at each point asked for, and by how much blur makes that wrong. A disc of radius r
// has the expectation E + c r^2 Laplace(E) + O(r^4), where c is the kernel's (Silverman 1986, section 4.3; 1/8 for the
// constant one): the difference to a disc of half the area is half of the bias (as in Hachisuka, Jarosz & Jensen 2010,
// from two radii). Both count the part of their area that lies on surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "coverage.glsl"
#include "density.glsl"
#include "film_layout.glsl"
#include "glossy_density.glsl"
#include "labels.glsl"
#include "radius_field.glsl"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_paths.h"

ARGS(GatherArgs)

void main() {
    Queue queue = args.queue.at[0];
    if (threadIndex() >= queue.count) return;
    uint slot = args.list.at[queue.first + threadIndex()];
    Query query = args.queries.at[slot];
    if (query.column == NONE) return;
    float radius = hasNearest && args.map.nearest > 0u
                       ? nearestRadius(args.map, query, args.map.nearest) * args.map.shrink
                       : radiusAt(args.map, query.position);
    if (args.map.partial != 0u) {
        // What is narrower than a pixel is not seen, and most paths from the eye would miss it.
        radius = radius > 0.0 ? max(radius, args.map.shrink * query.footprint) : GREATEST;
        if (radius > args.map.radius) return;
        args.queries.at[slot].column = NONE;
    }
    vec3 inner;
    vec3 irradiance = hasWide && (query.lobes & BY_WIDE) != 0u
                          ? estimateByLobes(DeviceScenePtr(args.scene).at[0], args.map, query, radius, inner)
                          : estimateWithin(args.map, query, radius, inner);
    irradiance *= args.map.photonFlux;
    if (args.scene != uvec2(0u) && maxComponent(irradiance) > 0.0) {
        vec2 factor = inverseCoverage(DeviceScenePtr(args.scene).at[0], query, radius);
        irradiance *= factor.x;
        inner *= factor.y;
    }
    if (hasBias)
        addToColumns(args.samples, args.stride, query.column == COLUMN_GATHERED ? COLUMN_GATHERED_BIAS : COLUMN_BIAS,
                     slot, 2.0 * query.weight * (irradiance - inner * args.map.photonFlux));
    addToColumns(args.samples, args.stride, query.column, slot, query.weight * irradiance);
    labelLight(args.samples, args.stride, slot, query.column, query.weight * irradiance, FOUND_BY_PHOTONS);
}
