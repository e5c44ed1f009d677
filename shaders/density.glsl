// Density estimation: irradiance at a point from the photons around it.
#ifndef DENSITY_GLSL
#define DENSITY_GLSL
#include "common.glsl"
#include "directions.glsl"
#include "grid.glsl"
#include "lobes.glsl"
#include "shared_camera.h"
#include "shared_photons.h"

// Weight of a photon at squared distance x2 (in units of the radius), over the mean weight of the disc.
// Cone with k = 1.1 (Jensen 1996), Gauss with alpha = 0.918, beta = 1.953 (Pavicic 1990, as in Jensen 2001, here
// normalised), Epanechnikov 1969.
float densityWeight(uint kernel, float x2) {
    if (kernel == DENSITY_KERNEL_CONE) return (1.0 - sqrt(x2) / 1.1) / 0.39393939;
    if (kernel == DENSITY_KERNEL_GAUSS)
        return 0.918 * (1.0 - (1.0 - exp(-1.953 * 0.5 * x2)) / (1.0 - exp(-1.953))) / 0.5311549;
    if (kernel == DENSITY_KERNEL_EPANECHNIKOV) return 2.0 * (1.0 - x2);
    return 1.0;
}

// A photon at offset d counts for a query if it is nearer than the radius and lies near the tangent plane, within a
// tenth of the radius, so that curved surfaces keep their photons,
bool isNear(vec3 d, Query query, float radius) {
    return dot(d, d) < radius * radius && abs(dot(d, query.normal)) <= 0.1 * radius;
}

// Photons on rough glass are marked by signs of their colours: negative in green, and in red where they arrived from
// inside. Whoever asks elsewhere does not count them.
const uint SIGN = 0x80000000u;
float marked(float value) { return uintBitsToFloat(floatBitsToUint(value) | SIGN); }
bool isMarked(float value) { return (floatBitsToUint(value) & SIGN) != 0u; }
vec3 markedOnGlass(vec3 color, bool inside) {
    return vec3(inside ? marked(color.r) : color.r, marked(color.g), color.b);
}

// and if it arrived on the same side; on rough glass on either side, of the same face.
bool isOnSide(PhotonMap map, uint i, Query query) {
    vec3 side = unpackDirection(PhotonPtr(map.photons).at[i].normal);
    if (hasWideGlass) {
        vec3 color = PhotonPtr(map.photons).at[i].color;
        bool onGlass = isMarked(color.g);
        if (onGlass != ((query.lobes & BY_GLASS) != 0u)) return false;
        if (onGlass && isMarked(color.r) != ((query.lobes & BY_INSIDE) != 0u)) side = -side;
    }
    float cosine = dot(side, query.normal);
    return cosine > 0.0 && cosine * cosine > 0.25 * dot(side, side);
}

// The squared distance of a photon that counts, or the greatest float.
float photonDistance2(PhotonMap map, uint i, Query query, float radius) {
    vec3 d = PhotonPtr(map.photons).at[i].position - query.position;
    return isNear(d, query, radius) && isOnSide(map, i, query) ? dot(d, d) : GREATEST;
}

// Sum of the photons' colours under the kernel, and within the disc of half the area under the kernel of that one.
struct Sums {
    vec3 outer;
    vec3 inner; // zero if no bias is estimated
};

// A photon of a colour at squared distance `distance2`.
void addPhoton(PhotonMap map, vec3 color, float distance2, float radius, inout Sums sums) {
    uint kernel = densityKernel == ANY ? map.kernel : densityKernel;
    float x2 = distance2 / (radius * radius);
    sums.outer += color * densityWeight(kernel, x2);
    if (hasBias) sums.inner += x2 < 0.5 ? color * densityWeight(kernel, 2.0 * x2) : vec3(0.0);
}

// Sum of the photons' colours under the kernel, per area of the disc. If bias is estimated, `inner` is the same of the
// disc of half the area in the same photons, else zero.
vec3 estimateWithin(PhotonMap map, Query query, float radius, out vec3 inner) {
    Cells cells = cellsAround(map, query.position, query.normal, radius);
    Sums sums = Sums(vec3(0.0), vec3(0.0));
    for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(map, cells, corner);
        for (uint i = range.x; i < range.y; i++) {
            vec3 d = PhotonPtr(map.photons).at[i].position - query.position;
            if (isNear(d, query, radius)) // nested: a twelfth faster on lavapipe than a function of both
                if (isOnSide(map, i, query))
                    addPhoton(map, PhotonPtr(map.photons).at[i].color, dot(d, d), radius, sums);
        }
    }
    float perArea = 1.0 / (PI * radius * radius);
    inner = 2.0 * perArea * sums.inner;
    return perArea * sums.outer;
}

vec3 estimateWithin(PhotonMap map, Query query, float radius) {
    vec3 inner;
    return estimateWithin(map, query, radius, inner);
}

// Photons nearer than `low`, and those in [low, high) by interval of squared distance.
const uint BINS = 16u;
uint countBins(PhotonMap map, Query query, float low, float high, out uint bins[BINS]) {
    uint below = 0u;
    for (uint b = 0u; b < BINS; b++) bins[b] = 0u;
    Cells cells = cellsAround(map, query.position, query.normal, map.radius);
    for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(map, cells, corner);
        for (uint i = range.x; i < range.y; i++) {
            float distance2 = photonDistance2(map, i, query, map.radius);
            if (distance2 < low) below++;
            else if (distance2 < high) bins[min(uint((distance2 - low) / (high - low) * float(BINS)), BINS - 1u)]++;
        }
    }
    return below;
}

// The greatest squared distance below `high` of a photon that counts, or 0.
float farthestBelow(PhotonMap map, Query query, float high) {
    float farthest = 0.0;
    Cells cells = cellsAround(map, query.position, query.normal, map.radius);
    for (uint corner = 0u; corner < 8u; corner++) {
        uvec2 range = cellRange(map, cells, corner);
        for (uint i = range.x; i < range.y; i++) {
            float distance2 = photonDistance2(map, i, query, map.radius);
            if (distance2 < high) farthest = max(farthest, distance2);
        }
    }
    return farthest;
}

// Distance of the k-th nearest photon, or the map's radius if fewer are within it. An interval of squared distance is
// narrowed sixteenfold at a time until it holds that photon alone (or, after five times, photons equally far to 2^-20).
// The photon itself is not inside the disc of that radius: k - 1 are, which makes the estimate unbiased.
float nearestRadius(PhotonMap map, Query query, uint k) {
    float low = 0.0;
    float high = map.radius * map.radius;
    for (uint round = 0u; round < 5u; round++) {
        uint bins[BINS];
        uint below = countBins(map, query, low, high, bins);
        uint b = 0u;
        while (b < BINS && below + bins[b] < k) below += bins[b++];
        if (b == BINS) return round == 0u ? map.radius : sqrt(high);
        float width = (high - low) / float(BINS);
        low += float(b) * width;
        high = low + width;
        if (below + 1u == k && bins[b] == 1u) break;
    }
    float farthest = farthestBelow(map, query, high);
    const float inward = 0.999999; // the square of a rounded root may be greater, and the photon inside again
    return inward * sqrt(farthest > 0.0 ? farthest : high);
}

#endif
