// The film: layers, columns of samples and of their sums.
#ifndef SHARED_FILM_H
#define SHARED_FILM_H
#include "shared.h"
#include "shared_paths.h"

SHARED_BEGIN

// Samples and their sums are stored column by column: a float for each pixel, then those of the next column. What a
// render does without has no column. One pass gives a pixel its radiance by layer and what it knows of the first
// surface seen: albedo, shading normal, depth (distance along the camera's axis), covered (1 if there was a surface),
// and an estimate of the bias of beauty. Sums over a run of passes have the squared deviations of beauty between
// batches of passes as well, what rounding took from the sums of the layers, see accumulate.glsl, and the square of the
// luminance of the bias.
#define COLUMNS(X)                                                                                                     \
    X(COLUMN_EMISSION, 0u)                                                                                             \
    X(COLUMN_DIRECT, COLUMN_EMISSION + 3u * uint(hasEmissionLayer))                                                    \
    X(COLUMN_SPECULAR, COLUMN_DIRECT + 3u * uint(hasDirectLayer))                                                      \
    X(COLUMN_CAUSTIC, COLUMN_SPECULAR + 3u * uint(hasSpecularLayer))                                                   \
    X(COLUMN_INDIRECT, COLUMN_CAUSTIC + 3u * uint(hasCausticLayer))                                                    \
    X(COLUMN_ALBEDO, COLUMN_INDIRECT + 3u * uint(hasIndirectLayer))                                                    \
    X(COLUMN_NORMAL, COLUMN_ALBEDO + 3u * uint(hasAlbedo))                                                             \
    X(COLUMN_DEPTH, COLUMN_NORMAL + 3u * uint(hasNormal))                                                              \
    X(COLUMN_COVERED, COLUMN_DEPTH + uint(hasDepth))                                                                   \
    X(COLUMN_BIAS, COLUMN_COVERED + uint(hasDepth))                                                                    \
    X(SAMPLE_COLUMNS, COLUMN_BIAS + 3u * uint(hasBias))                                                                \
    X(COLUMN_SMALL_BATCHES, SAMPLE_COLUMNS)                                                                            \
    X(COLUMN_LARGE_BATCHES, COLUMN_SMALL_BATCHES + 3u * uint(hasNoise))                                                \
    X(COLUMN_COMPENSATION, COLUMN_LARGE_BATCHES + 3u * uint(hasNoise))                                                 \
    X(COLUMN_SQUARE, COLUMN_COMPENSATION + 3u * uint(hasNoise))                                                        \
    X(SUM_COLUMNS, COLUMN_SQUARE + uint(hasBias))

// After these the samples of camera paths have what gather rays bring to the diffuse point of a pixel (irradiance over
// pi), and the bias of that.
const uint GATHERED_COLUMNS = 6u;

#ifdef __cplusplus
/// Where the columns begin, and how many there are.
struct Columns : Features {
#define X(name, value) uint name;
    COLUMNS(X)
#undef X
    explicit Columns(const Features& features = {}) : Features(features) {
#define X(name, value) name = value;
        COLUMNS(X)
#undef X
    }
    /// Those of camera paths before their gathers are shared.
    uint cameraColumns() const { return SAMPLE_COLUMNS + GATHERED_COLUMNS * uint(hasGlobalMap); }
};
#else
#define X(name, value) const uint name = value;
COLUMNS(X)
#undef X
const uint COLUMN_GATHERED = SAMPLE_COLUMNS;
const uint COLUMN_GATHERED_BIAS = COLUMN_GATHERED + 3u;
const uint CAMERA_COLUMNS = SAMPLE_COLUMNS + GATHERED_COLUMNS * uint(hasGlobalMap);
#endif

/// Passes begin .. end - 1.
struct PassRange {
    uint begin;
    uint end;
};

/// How the deviations of two adjacent runs of passes make those of both, see accumulate.glsl.
struct JoinWeights {
    float perPass; // 1 / passes of the first run, or 0 if it has none
    uint times;    // passes of the first over those of the second: a whole number
    float fine;
    float coarse;
    uint grows; // 1: the first run is a batch like the second, and both become one of the next size
};

struct FilmArgs {
    PTR(float) samples; // [column][stride], of a pass
    PTR(float) sums;    // [column][pixels], of a run of passes; becomes those of both
    PTR(Status) status;
    uint stride;
    uint pixels;
    uint firstPixel;
    uint count;
    JoinWeights weights;
};

struct JoinArgs {
    PTR(float) sums;  // [column][pixels]; becomes those of both
    PTR(float) other; // [column][pixels]
    uint pixels;
    JoinWeights weights;
};

SHARED_END
#endif
