// Thinning of overfull cells: where more than MAX_PHOTONS_PER_CELL photons share a key, they are cut into that many
// runs of equal length (to one), one photon of each run is chosen at random, and carries the flux of all. The
// expectation of every gather stays as it is, and no gather reads more than MAX_PHOTONS_PER_CELL photons of a cell.
// Stratified sampling (Cochran 1977, chapter 5).
#ifndef CELL_THINNING_GLSL
#define CELL_THINNING_GLSL
#include "common.glsl"
#include "hash.h"
#include "random.glsl"
#include "shared_photons.h"

// A run of consecutive photons of a cell.
struct Run {
    uint first;
    uint size;
};

// The first photon of the k-th of MAX_PHOTONS_PER_CELL runs of `count` photons; 32 bits are enough for it.
uint runStart(uint k, uint count) {
    return k * (count / MAX_PHOTONS_PER_CELL) + k * (count % MAX_PHOTONS_PER_CELL) / MAX_PHOTONS_PER_CELL;
}

// The run that holds photon j of `count`.
Run runOf(uint j, uint count) {
    uint k =
        min(uint(float(j) / float(count) * float(MAX_PHOTONS_PER_CELL)), MAX_PHOTONS_PER_CELL - 1u); // to a rounding
    while (k + 1u < MAX_PHOTONS_PER_CELL && runStart(k + 1u, count) <= j) k++;
    while (runStart(k, count) > j) k--;
    uint first = runStart(k, count);
    return Run(first, runStart(k + 1u, count) - first);
}

// What photon i of a map in the order of its keys weighs after thinning: 0 if it is left out.
uint weightAfterThinning(uintPtr keys, uintPtr cells, uint i, uint pass) {
    uint key = keys.at[i];
    uint first = cells.at[key];
    uint count = cells.at[key + 1u] - first;
    if (count <= MAX_PHOTONS_PER_CELL) return 1u;
    Run run = runOf(i - first, count);
    uint chosen;
    uint unused;
    umulExtended(hash(hash(key, run.first), pass), run.size, chosen, unused);
    return i - first == run.first + chosen ? run.size : 0u;
}

#endif
