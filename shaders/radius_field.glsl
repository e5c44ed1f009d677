// The first gather radius as a function of the place: cells of a hashed grid hold its binary logarithm, in units of the
// map's radius.
#ifndef RADIUS_FIELD_GLSL
#define RADIUS_FIELD_GLSL
#include "common.glsl"
#include "hash.h"
#include "random.glsl"
#include "shared_photons.h"

uint fieldSlot(PhotonMap map, ivec3 cell) {
    return hash(uvec3(cell)) & ((map.partial != 0u ? NARROW_FIELD_CELLS : FIELD_CELLS) - 1u);
}

// Interpolated between the middles of the eight cells around a point, of those that have a value. Elsewhere the map's
// radius; in a map of narrow discs alone 0, unless half of the point's surroundings have values.
float radiusAt(PhotonMap map, vec3 position) {
    if (!hasRadiusField || map.fieldPerUnit == 0.0) return map.radius;
    vec3 place = clamp(position * map.fieldPerUnit, -1.0e9, 1.0e9) - 0.5;
    ivec3 first = ivec3(floor(place));
    vec3 part = place - floor(place);
    float sum = 0.0;
    float weights = 0.0;
    for (uint corner = 0u; corner < 8u; corner++) {
        ivec3 side = ivec3(corner >> 2, corner >> 1 & 1u, corner & 1u);
        float value = floatPtr(map.field).at[fieldSlot(map, first + side)];
        if (value > 0.0) continue; // unknown
        vec3 near = mix(1.0 - part, part, vec3(side));
        float weight = near.x * near.y * near.z;
        sum += weight * value;
        weights += weight;
    }
    if (map.partial != 0u && weights < 0.5) return 0.0;
    return weights > 0.0 ? map.radius * exp2(sum / weights) : map.radius;
}

#endif
