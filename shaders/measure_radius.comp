// Measures, at each photon of a pilot map, the radius of a disc that holds `perDisc` photons, and adds its logarithm to
// the cell of the radius field.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "grid.glsl"
#include "radius_field.glsl"
#include "shared_photons.h"

ARGS(MeasureRadiusArgs)

// Photons expected in a disc of the radius that the cells of a level are made for, from those in the eight cells that
// cover it; on a flat surface these have an area of 4 x 2.1^2 radii squared.
float photonsInDisc(vec3 position, uint level) {
    Cells cells = cellsAround(args.map, position, vec3(0.0), ldexp(args.map.radius, -int(level)));
    cells.reach2 = GREATEST; // all eight count, whole
    cells.low = 2 * cells.first;
    cells.high = cells.low + 3;
    uint photons = 0u;
    [[dont_unroll]] for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(args.map, cells, corner);
        photons += range.y - range.x;
    }
    return float(photons) * (PI / 17.64);
}

// Binary logarithm of the radius in units of the map's. The finest level decides whose disc holds enough; within it the
// radius follows the density, but not below the next level's, whose disc holds too few.
float logRadius(vec3 position) {
    float photons = 0.0;
    uint level = 0u;
    for (; level <= args.map.levels; level++) {
        float finer = photonsInDisc(position, level);
        if (level > 0u && finer < args.perDisc) break;
        photons = finer;
    }
    return clamp(0.5 * log2(args.perDisc / photons), -1.0, 0.0) - float(level - 1u);
}

void main() {
    uint i = threadIndex() * args.stride;
    if (i >= args.count) return;
    vec3 position = PhotonPtr(args.map.photons).at[i].position;
    float wanted = -logRadius(position);
    if (args.map.partial != 0u) {
        args.wanted.at[threadIndex()] = WantedRadius(position, wanted);
        return;
    }
    float value = clamp(wanted, 0.0, float(args.map.levels));

    // Integers, so that the order of adding does not matter.
    uint slot = fieldSlot(args.map, ivec3(floor(clamp(position * args.map.fieldPerUnit, -1.0e9, 1.0e9))));
    if (wanted >= float(args.map.levels + 1u)) atomicAdd(args.sums.at[2u * FIELD_CELLS], 1u);
    atomicAdd(args.sums.at[2u * slot], uint(value * PILOT_UNIT + 0.5));
    atomicAdd(args.sums.at[2u * slot + 1u], 1u);
}
