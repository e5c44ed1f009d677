// Columns of samples and of their sums: which there are, reading them, and adding to them.
#ifndef FILM_LAYOUT_GLSL
#define FILM_LAYOUT_GLSL
#include "common.glsl"
#include "shared_film.h"
#include "shared_layers.h"

// Whether a layer is rendered at all.
bool hasLayer(uint layer) {
    switch (layer) {
    case LAYER_EMISSION:
        return hasEmissionLayer;
    case LAYER_DIRECT:
        return hasDirectLayer;
    case LAYER_SPECULAR:
        return hasSpecularLayer;
    case LAYER_CAUSTIC:
        return hasCausticLayer;
    default:
        return hasIndirectLayer;
    }
}

// The first of a layer's three columns.
uint layerColumn(uint layer) {
    switch (layer) {
    case LAYER_EMISSION:
        return COLUMN_EMISSION;
    case LAYER_DIRECT:
        return COLUMN_DIRECT;
    case LAYER_SPECULAR:
        return COLUMN_SPECULAR;
    case LAYER_CAUSTIC:
        return COLUMN_CAUSTIC;
    default:
        return COLUMN_INDIRECT;
    }
}

// What three columns, the first of them given, hold at a place; `stride` is the length of a column.
vec3 loadColumns(floatPtr columns, uint stride, uint column, uint place) {
    uint at = column * stride + place;
    return vec3(columns.at[at], columns.at[at + stride], columns.at[at + 2u * stride]);
}

void storeColumns(floatPtr columns, uint stride, uint column, uint place, vec3 value) {
    uint at = column * stride + place;
    columns.at[at] = value.x;
    columns.at[at + stride] = value.y;
    columns.at[at + 2u * stride] = value.z;
}

void addToColumns(floatPtr columns, uint stride, uint column, uint place, vec3 value) {
    storeColumns(columns, stride, column, place, loadColumns(columns, stride, column, place) + value);
}

#endif
