// Sums over passes. The same bits come out wherever and in whatever parts they are computed: only sums and
// products of numbers that the host gives, kept from being contracted.
//
// Runs of passes are nodes of a tree (host/render/pass_runs.h): four batches of 4^k passes make one of 4^(k + 1). How
// batches differ says how far their mean may be from the truth, better than single passes do, whose points were made to
// complement each other. A run that is made of batches of 4^k passes keeps the squared deviations of their beauty from
// its mean, with batches as weights (large batches), and those of batches of 4^(k - 1) passes (small batches).
//
// Deviations are small differences of large sums. So a run also keeps what roundings took from the sums of its layers
// (compensation), and differences are made before sums.
#ifndef ACCUMULATE_GLSL
#define ACCUMULATE_GLSL
#include "common.glsl"
#include "film_layout.glsl"
#include "shared_film.h"
#include "shared_layers.h"

// Takes a batch whose mean beauty is `apart` from a run's, and which has coarse deviations of its own, into the
// deviations of the run: its coarse ones are fine to the run (Chan, Golub & LeVeque 1979, eq. 2.1b).
void joinDeviations(floatPtr sums, uint pixels, uint pixel, vec3 apart, vec3 batch, JoinWeights w) {
    vec3 fine = loadColumns(sums, pixels, COLUMN_SMALL_BATCHES, pixel);
    vec3 coarse = loadColumns(sums, pixels, COLUMN_LARGE_BATCHES, pixel);
    precise vec3 square = apart * apart;
    precise vec3 newFine = (w.grows != 0u ? coarse : fine) + batch + square * w.fine;
    precise vec3 newCoarse = (w.grows != 0u ? vec3(0.0) : coarse) + square * w.coarse;
    storeColumns(sums, pixels, COLUMN_SMALL_BATCHES, pixel, newFine);
    storeColumns(sums, pixels, COLUMN_LARGE_BATCHES, pixel, newCoarse);
}

// What rounding took from the sum s of a and b, exactly (Knuth 1997, section 4.2.2, theorem B).
vec3 lostInSum(vec3 a, vec3 b, vec3 s) {
    precise vec3 bWithin = s - a;
    precise vec3 lost = (a - (s - bWithin)) + (b - bWithin);
    return lost;
}

// a - times b, times at most 3; exact where these are near each other, since each step takes a number from one that is
// at most twice as large (Sterbenz 1974).
vec3 minusTimes(vec3 a, vec3 b, uint times) {
    precise vec3 difference = a;
    if (times >= 2u) difference -= 2.0 * b;
    if ((times & 1u) != 0u) difference -= b;
    return difference;
}

// Takes the beauty of a batch, columns `other` at the place `slot`, into the deviations and the rest of a run, before
// the batch is added to its sums. `rest` and `batch` are the batch's own rest and coarse deviations.
void joinBeauty(floatPtr sums, uint pixels, uint pixel, floatPtr other, uint stride, uint slot, vec3 rest, vec3 batch,
                JoinWeights w) {
    vec3 ownRest = loadColumns(sums, pixels, COLUMN_COMPENSATION, pixel);
    precise vec3 apart = minusTimes(ownRest, rest, w.times);
    precise vec3 newRest = ownRest + rest;
    [[dont_unroll]] for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        if (!hasLayer(layer)) continue;
        vec3 a = loadColumns(sums, pixels, layerColumn(layer), pixel);
        vec3 b = loadColumns(other, stride, layerColumn(layer), slot);
        precise vec3 sum = a + b;
        apart += minusTimes(a, b, w.times);
        newRest += lostInSum(a, b, sum);
    }
    precise vec3 meanApart = apart * w.perPass;
    joinDeviations(sums, pixels, pixel, meanApart, batch, w);
    storeColumns(sums, pixels, COLUMN_COMPENSATION, pixel, newRest);
}

#endif
