// Gives each diffuse point that the eye sees the mean of what gather rays bring to it and to its neighbours: the points
// of pixels around that lie within a radius, near its tangent plane, on the same side (path space filtering, Keller,
// Dahm & Binder 2014). Only what arrives is shared, so that albedos stay sharp; the radius shrinks from pass to pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "film_layout.glsl"
#include "labels.glsl"
#include "random.glsl"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_scene.h"

ARGS(ShareGathersArgs)

const int MOST_NEIGHBOURS = 49; // about as many pixels are looked at,
const int WIDEST_WINDOW = 64;   // at most so far away

// Columns and rows of pixels: from `first` to `last`, by steps.
struct Window {
    ivec2 first;
    ivec2 last;
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

// The rows of a pixel's band, first and last: only pixels of one band share, so that a batch of whole bands has all
// that it needs. Where bands meet differs from pass to pass.
ivec2 bandRows(int row) {
    int band = int(SHARING_BAND), first = (row + int(args.bandShift)) / band * band - int(args.bandShift);
    return ivec2(max(first, 0), min(first + band, int(args.firstRow + args.count / args.width)) - 1);
}

// A window that holds the disc about the point of a pixel, within its band, with steps wide enough for MOST_NEIGHBOURS.
// Which pixels it steps on is drawn for each pixel and pass, so that no pattern is seen.
Window windowAround(Split here, ivec2 pixel) {
    ivec2 disc = ivec2(clamp(args.radius / pixelSteps(here), 0.0, float(WIDEST_WINDOW)));
    ivec2 rows = bandRows(pixel.y);
    ivec2 first = max(pixel - disc, ivec2(0, rows.x)), last = min(pixel + disc, ivec2(args.width - 1u, rows.y));
    ivec2 wide = last - first + 1, stride = ivec2(1);
    while (wide.x * wide.y > MOST_NEIGHBOURS * stride.x * stride.y)
        if (wide.x * stride.y >= wide.y * stride.x) stride.x++;
        else stride.y++;
    uint draw = hash(uint(pixel.y) * args.width + uint(pixel.x), args.pass);
    return Window(first + ivec2(uvec2(draw & 0xffffu, draw >> 16) % uvec2(stride)), last, stride);
}

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
    vec3 offset; // sum of those of the neighbours: to one side at an edge
    vec3 moment; // sum of these times the luminance of the values
};

void add(uint slot, vec3 offset, bool isInner, inout Shared gathered) {
    vec3 value = loadColumns(args.samples, args.stride, COLUMN_GATHERED, slot);
    gathered.sum += value;
    gathered.count += 1.0;
    if (!hasBias) return;
    gathered.bias += loadColumns(args.samples, args.stride, COLUMN_GATHERED_BIAS, slot);
    if (isInner) gathered.inner += value;
    gathered.innerCount += float(isInner);
    gathered.offset += offset;
    gathered.moment += luminance(value) * offset;
}

// A sample that is not finite stays with its pixel, where the film counts it.
Shared gatheredAround(uint slot, Split here) {
    Shared gathered = Shared(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec3(0.0), vec3(0.0));
    add(slot, vec3(0.0), true, gathered);
    uint first = args.firstRow * args.width;
    ivec2 pixel = ivec2((first + slot) % args.width, (first + slot) / args.width);
    Window window = windowAround(here, pixel);
    for (int y = window.first.y; y <= window.last.y; y += window.stride.y)
        for (int x = window.first.x; x <= window.last.x; x += window.stride.x) {
            uint other = uint(y) * args.width + uint(x) - first;
            float distance2;
            if (other == slot || !isNeighbour(here, args.splits.at[other], distance2)) continue;
            if (isFinite(loadColumns(args.samples, args.stride, COLUMN_GATHERED, other)))
                add(other, args.splits.at[other].origin - here.origin, distance2 < 0.5 * args.radius * args.radius,
                    gathered);
        }
    return gathered;
}

// The bias of the mean over the disc, from that and the mean over the disc of half the area. Around a point bias is of
// second order in the radius, and the difference half of it. At a straight edge towards which the values rise or fall
// the neighbours are off that way by 4 / (3 pi) of the radius in their mean; bias is of first order, and the difference
// 1 - sqrt(1/2) of it.
vec3 biasOfSharing(vec3 mean, Shared gathered) {
    vec3 offset = gathered.offset / gathered.count;
    vec3 rise = gathered.moment / gathered.count - luminance(mean) * offset;
    float aside = abs(dot(offset, rise)) / max(length(rise), 1e-30) * 0.75 * PI / args.radius;
    float first = clamp(aside * aside - 2.0 / gathered.count, 0.0, 1.0); // without what chance does to so many
    return mix(2.0, 3.4142136, first) * (mean - gathered.inner / gathered.innerCount);
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    Split here = args.splits.at[slot];
    uint layer = (here.flags & PATH_EYE_SPECULAR) != 0u ? LAYER_SPECULAR : LAYER_INDIRECT;
    if (here.flags == NONE || !hasLayer(layer)) return;
    Shared gathered = gatheredAround(slot, here);
    vec3 mean = gathered.sum / gathered.count, weight = args.weight * here.throughput;
    addToColumns(args.samples, args.stride, layerColumn(layer), slot, weight * mean);
    labelLight(args.samples, args.stride, slot, layerColumn(layer), weight * mean, FOUND_BY_GATHERING);
    if (hasBias)
        addToColumns(args.samples, args.stride, COLUMN_BIAS, slot,
                     weight * (gathered.bias / gathered.count + biasOfSharing(mean, gathered)));
}
