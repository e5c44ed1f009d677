// The first gather radius as a function of the place: cells of a hashed grid hold its binary logarithm, in units of the
// map's radius; needs random.glsl.

uint fieldSlot(ivec3 cell, uint mask) {
    return hash(uvec3(cell)) & mask;
}

// Interpolated between the middles of the eight cells around a point, of those that have a value. Elsewhere the map's radius.
float radiusAt(PhotonMap map, vec3 position) {
    if (hasRadiusField == 0u || map.fieldMask == 0u) return map.radius;
    vec3 place = clamp(position * map.fieldPerUnit, -1.0e9, 1.0e9) - 0.5;
    ivec3 first = ivec3(floor(place));
    vec3 part = place - floor(place);
    float sum = 0.0;
    float weights = 0.0;
    for (uint corner = 0u; corner < 8u; corner++) {
        ivec3 side = ivec3(corner >> 2, corner >> 1 & 1u, corner & 1u);
        float value = floatPtr(map.field).at[fieldSlot(first + side, map.fieldMask)];
        if (value > 0.0) continue; // unknown
        vec3 near = mix(1.0 - part, part, vec3(side));
        float weight = near.x * near.y * near.z;
        sum += weight * value;
        weights += weight;
    }
    return weights > 0.0 ? map.radius * exp2(sum / weights) : map.radius;
}
