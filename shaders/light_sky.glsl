// The sky: directions in proportion to the flux of its texels, uniform over the solid angle of each.
#ifndef LIGHT_SKY_GLSL
#define LIGHT_SKY_GLSL
#include "common.glsl"
#include "sampling.glsl"
#include "shared_scene.h"

// A direction to the sky, what comes from there, and the solid angle that it stands for: one over the density.
struct SkyPoint {
    vec3 w;
    vec3 radiance;
    float inversePdf;
};

// The difference of the cosines between which a row lies.
float cosinesOfRow(Sky sky, uint row) {
    return sky.rowHeight * unitCircle((float(row) + 0.5) / (2.0 * float(sky.height))).y;
}

float solidAngleOfTexel(Sky sky, uint row) { return sky.columnAngle * cosinesOfRow(sky, row); }

// One minus the cosine of the angle between a row's upper edge and the pole.
float heightOfRow(Sky sky, uint row) {
    float sine = unitCircle(float(row) / (4.0 * float(sky.height))).y;
    return 2.0 * sine * sine;
}

// Which part of the unit interval holds u: its index among `count` whose upper ends are given, its width, and where in
// it u is.
struct Part {
    uint index;
    float width;
    float within;
};

Part partOf(float u, float low, float high, uint index) {
    return Part(index, high - low, min((u - low) / (high - low), BELOW_ONE));
}

Part rowAt(Sky sky, float u) {
    uint row = firstAbove(sky.rows, 0u, 1u, sky.height, u);
    return partOf(u, row > 0u ? floatPtr(sky.rows).at[row - 1u] : 0.0, floatPtr(sky.rows).at[row], row);
}

Part columnAt(Sky sky, uint row, float u) {
    uint first = row * sky.width, column = firstAbove(sky.texels, 4u * first + 3u, 4u, sky.width, u); // by SkyTexel.cdf
    return partOf(u, column > 0u ? SkyTexelPtr(sky.texels).at[first + column - 1u].cdf : 0.0,
                  SkyTexelPtr(sky.texels).at[first + column].cdf, column);
}

// The direction at a place of a texel, both from 0 to 1; from the nearer pole, where a cosine has no digits.
vec3 skyDirection(Sky sky, uint row, uint column, vec2 place) {
    bool below = row >= (sky.height + 1u) / 2u;
    uint fromPole = below ? sky.height - 1u - row : row;
    float height = min(heightOfRow(sky, fromPole) + place.x * cosinesOfRow(sky, fromPole), 2.0);
    float across = sqrt(height * (2.0 - height));
    vec2 turn = unitCircle((float(column) + place.y) / float(sky.width)); // from the left edge, opposite to the front
    return (below ? height - 1.0 : 1.0 - height) * sky.up - across * (turn.x * sky.front + turn.y * sky.right);
}

SkyPoint sampleSky(DeviceScene scene, vec2 u) {
    Sky sky = SkyPtr(scene.sky).at[0];
    Part row = rowAt(sky, u.x);
    Part column = columnAt(sky, row.index, u.y);
    return SkyPoint(skyDirection(sky, row.index, column.index, vec2(row.within, column.within)),
                    SkyTexelPtr(sky.texels).at[row.index * sky.width + column.index].radiance,
                    solidAngleOfTexel(sky, row.index) / (row.width * column.width));
}

// Where a direction lies in the picture: its texel and the place in that, as in skyDirection.
struct SkyPlace {
    uint row;
    uint column;
    vec2 within;
};

SkyPlace skyPlace(Sky sky, vec3 w) {
    vec3 p = vec3(dot(w, sky.front), dot(w, sky.right), dot(w, sky.up));
    uint row = min(uint(angleAbove(vec2(p.z, length(p.xy))) * (float(sky.height) / PI)), sky.height - 1u);
    float turn = angleAbove(vec2(p.x, abs(p.y))) / (2.0 * PI);
    float columns = (0.5 + (p.y < 0.0 ? -turn : turn)) * float(sky.width);
    uint column = min(uint(columns), sky.width - 1u);
    bool below = row >= (sky.height + 1u) / 2u;
    uint fromPole = below ? sky.height - 1u - row : row;
    float rest = dot(p.xy, p.xy) / (1.0 + abs(p.z)); // 1 - |p.z|
    float height = (below ? -p.z : p.z) < 0.0 ? 2.0 - rest : rest;
    vec2 within = vec2((height - heightOfRow(sky, fromPole)) / cosinesOfRow(sky, fromPole), columns - float(column));
    return SkyPlace(row, column, clamp(within, 0.0, BELOW_ONE));
}

// The parts of the unit interval that lead to a texel: row first, then column.
vec2 partsOf(Sky sky, uint row, uint column, out vec2 before) {
    uint index = row * sky.width + column;
    before = vec2(row > 0u ? floatPtr(sky.rows).at[row - 1u] : 0.0,
                  column > 0u ? SkyTexelPtr(sky.texels).at[index - 1u].cdf : 0.0);
    return vec2(floatPtr(sky.rows).at[row], SkyTexelPtr(sky.texels).at[index].cdf) - before;
}

// The numbers by which sampleSky comes to a direction.
vec2 numbersOfSky(DeviceScene scene, vec3 w) {
    Sky sky = SkyPtr(scene.sky).at[0];
    SkyPlace place = skyPlace(sky, w);
    vec2 before;
    vec2 parts = partsOf(sky, place.row, place.column, before);
    return min(before + parts * place.within, BELOW_ONE);
}

// What comes from a direction; the solid angle is 0 where samples never go.
SkyPoint skyAt(DeviceScene scene, vec3 w) {
    Sky sky = SkyPtr(scene.sky).at[0];
    SkyPlace place = skyPlace(sky, w);
    vec2 before;
    vec2 parts = partsOf(sky, place.row, place.column, before);
    float probability = parts.x * parts.y;
    return SkyPoint(w, SkyTexelPtr(sky.texels).at[place.row * sky.width + place.column].radiance,
                    probability > 0.0 ? solidAngleOfTexel(sky, place.row) / probability : GREATEST);
}

#endif
