// Sums over passes; needs columns.glsl. The same bits come out wherever and in whatever parts they are computed: only sums and
// products of numbers that the host gives, kept from being contracted.
//
// Runs of passes are nodes of a tree (host/render/pass_runs.h): four batches of 4^k passes make one of 4^(k + 1). How
// batches differ says how far their mean may be from the truth, better than single passes do, whose points were made to
// complement each other. A run that is made of batches of 4^k passes keeps the squared deviations of their beauty from its
// mean, with batches as weights (COARSE), and those of batches of 4^(k - 1) passes (FINE).

vec3 beautyOf(floatPtr columns, uint stride, uint place) {
    precise vec3 beauty = vec3(0.0);
    for (uint layer = 0u; layer < LAYER_COUNT; layer++)
        if (hasLayer(layer)) beauty += loadColumns(columns, stride, layerColumn(layer), place);
    return beauty;
}

// Takes a batch whose mean beauty is `apart` from a run's, and which has coarse deviations of its own, into the deviations of
// the run: its coarse ones are fine to the run (Chan, Golub & LeVeque 1979, eq. 2.1b).
void joinDeviations(floatPtr sums, uint pixels, uint pixel, vec3 apart, vec3 batch, JoinWeights w) {
    vec3 fine = loadColumns(sums, pixels, COLUMN_FINE, pixel);
    vec3 coarse = loadColumns(sums, pixels, COLUMN_COARSE, pixel);
    precise vec3 square = apart * apart;
    precise vec3 newFine = (w.grows != 0u ? coarse : fine) + batch + square * w.fine;
    precise vec3 newCoarse = (w.grows != 0u ? vec3(0.0) : coarse) + square * w.coarse;
    storeColumns(sums, pixels, COLUMN_FINE, pixel, newFine);
    storeColumns(sums, pixels, COLUMN_COARSE, pixel, newCoarse);
}
