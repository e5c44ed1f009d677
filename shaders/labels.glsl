// Which path brought a pixel most, for those who look for specks: in place of the albedo there are the events of the
// path under way, the luminance of the brightest light found, and how and where it was found. Compiled for --labels
// alone.
#ifndef LABELS_GLSL
#define LABELS_GLSL
#include "common.glsl"
#include "film_layout.glsl"

// Events of a path from the eye, two bits each after a leading one; the first ten of them.
const uint EVENT_REFLECTED = 0u;
const uint EVENT_WENT_THROUGH = 1u;
const uint EVENT_GLOSSY = 2u;
const uint MOST_EVENTS = 1u << 20u;

// How light was found after these events: by running into a light, by a light sample from a diffuse point, by the
// photons around it, or by gather rays from there and from its neighbours.
const uint FOUND_LIGHT = 0u;
const uint FOUND_BY_SAMPLE = 1u;
const uint FOUND_BY_PHOTONS = 2u;
const uint FOUND_BY_GATHERING = 3u;

void addEvent(floatPtr samples, uint stride, uint slot, uint event) {
    if (!hasLabels || !hasAlbedo) return;
    uint at = COLUMN_ALBEDO * stride + slot;
    uint events = max(uint(samples.at[at]), 1u);
    if (events < MOST_EVENTS) samples.at[at] = float(events << 2 | event);
}

// A further path of the pixel begins.
void forgetEvents(floatPtr samples, uint stride, uint slot) {
    if (hasLabels && hasAlbedo) samples.at[COLUMN_ALBEDO * stride + slot] = 0.0;
}

// Whether a column has labels, in place of what is added up.
bool isLabel(uint column) { return hasLabels && hasAlbedo && column >= COLUMN_ALBEDO && column < COLUMN_ALBEDO + 3u; }

// The brighter light of two slots goes to the first one.
void joinLabels(floatPtr samples, uint stride, uint slot, uint other) {
    if (!hasLabels || !hasAlbedo) return;
    uint at = (COLUMN_ALBEDO + 1u) * stride;
    if (!(samples.at[at + other] > samples.at[at + slot])) return;
    samples.at[at + slot] = samples.at[at + other];
    samples.at[at + stride + slot] = samples.at[at + stride + other];
}

// Light that is added to a column of a layer.
void labelLight(floatPtr samples, uint stride, uint slot, uint column, vec3 light, uint found) {
    if (!hasLabels || !hasAlbedo || column >= COLUMN_ALBEDO) return;
    uint at = COLUMN_ALBEDO * stride + slot;
    if (!(luminance(light) > samples.at[at + stride])) return;
    samples.at[at + stride] = luminance(light);
    samples.at[at + 2u * stride] = float(max(uint(samples.at[at]), 1u) << 2 | found);
}

#endif
