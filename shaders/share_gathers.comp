// Gives each diffuse point that the eye sees the mean of what gather rays bring to it and to its neighbours: the points
// of pixels around that lie within a radius, near its tangent plane, on the same side (path space filtering, Keller,
// Dahm & Binder 2014). Only what arrives is shared, so that albedos stay sharp; the radius shrinks from pass to pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "film_layout.glsl"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_scene.h"

ARGS(ShareGathersArgs)

const int MOST_NEIGHBOURS = 49; // about as many pixels are looked at

// Columns and rows of pixels around: at most `reach` steps of `stride` pixels to either side.
struct Window {
    ivec2 reach;
    ivec2 stride;
};

// How far the point would move over its tangent plane if its pixel moved by one, to the side and up; seen by way of
// specular surfaces, which turn what is seen, as if it faced the eye.
vec2 pixelSteps(Split here) {
    if ((here.flags & PATH_EYE_SPECULAR) != 0u) return vec2(here.footprint);
    Camera camera = args.scene.at[0].camera;
    vec3 toPoint = here.origin - camera.origin, right = normalize(camera.right), up = normalize(camera.up);
    const float edgeOn = 0.001; // narrower discs are lines
    float depth = max(abs(dot(toPoint, here.shading)), edgeOn * length(toPoint));
    if (dot(toPoint, here.shading) < 0.0) depth = -depth;
    return here.footprint * vec2(length(right - toPoint * (dot(right, here.shading) / depth)),
                                 length(up - toPoint * (dot(up, here.shading) / depth)));
}

// A window that holds the disc about a point, with steps wide enough for MOST_NEIGHBOURS, few where one side is narrow.
Window windowAround(Split here) {
    vec2 pixels = clamp(args.radius / pixelSteps(here), 0.0, 1024.0); // the disc's half widths
    int side = int(sqrt(float(MOST_NEIGHBOURS)) - 1.0) / 2;
    ivec2 least = min(ivec2(pixels), side), most = (MOST_NEIGHBOURS / (2 * least.yx + 1) - 1) / 2;
    ivec2 stride = ivec2(pixels / vec2(most + 1)) + 1;
    return Window(ivec2(pixels / vec2(stride)), stride);
}

// The band of a row: only pixels of one band share, so that a batch of whole bands has all that it needs.
int bandOf(int row) { return (row + int(args.bandShift)) / int(SHARING_BAND); }

// Whether the point of a slot shares with another, at squared distance `distance2`.
bool isNeighbour(Split here, Split there, out float distance2) {
    vec3 d = there.origin - here.origin;
    distance2 = dot(d, d);
    return there.flags == here.flags && distance2 < args.radius * args.radius &&
           abs(dot(d, here.shading)) <= 0.1 * args.radius && dot(here.shading, there.shading) > 0.9;
}

struct Shared {
    vec3 sum;
    vec3 inner; // of the disc of half the area
    vec3 bias;
    float count;
    float innerCount;
};

void add(uint slot, bool isInner, inout Shared gathered) {
    vec3 value = loadColumns(args.samples, args.stride, COLUMN_GATHERED, slot);
    gathered.sum += value;
    gathered.count += 1.0;
    if (!hasBias) return;
    gathered.bias += loadColumns(args.samples, args.stride, COLUMN_GATHERED_BIAS, slot);
    if (isInner) gathered.inner += value;
    gathered.innerCount += float(isInner);
}

// A sample that is not finite stays with its pixel, where the film counts it.
Shared gatheredAround(uint slot, Split here) {
    Shared gathered = Shared(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
    add(slot, true, gathered);
    int width = int(args.width), row = int(slot) / width, rows = int(args.count) / width;
    int column = int(slot) - row * width, band = bandOf(row + int(args.firstRow));
    Window window = windowAround(here);
    for (int y = row - window.reach.y * window.stride.y; y <= row + window.reach.y * window.stride.y;
         y += window.stride.y) {
        if (y < 0 || y >= rows || bandOf(y + int(args.firstRow)) != band) continue;
        for (int x = column - window.reach.x * window.stride.x; x <= column + window.reach.x * window.stride.x;
             x += window.stride.x) {
            uint other = uint(y * width + x);
            float distance2;
            if (x < 0 || x >= width || other == slot || !isNeighbour(here, args.splits.at[other], distance2)) continue;
            if (isFinite(loadColumns(args.samples, args.stride, COLUMN_GATHERED, other)))
                add(other, distance2 < 0.5 * args.radius * args.radius, gathered);
        }
    }
    return gathered;
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    Split here = args.splits.at[slot];
    uint layer = (here.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : LAYER_INDIRECT;
    if (here.flags == NONE || !hasLayer(layer)) return;
    Shared gathered = gatheredAround(slot, here);
    vec3 mean = gathered.sum / gathered.count;
    addToColumns(args.samples, args.stride, layerColumn(layer), slot, here.throughput * mean);
    if (hasBias)
        addToColumns(args.samples, args.stride, COLUMN_BIAS, slot,
                     here.throughput *
                         (gathered.bias / gathered.count + 2.0 * (mean - gathered.inner / gathered.innerCount)));
}
