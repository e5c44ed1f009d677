/// A pixel as the host knows it: of a column that a render does without it has zeros.
#pragma once
#include "shared_layers.h"

namespace vkpm {

/// What passes gave a pixel: radiance by layer, and the first surface seen.
struct Sample {
    vec3 layers[LAYER_COUNT];
    vec3 albedo;
    vec3 normal;
    float depth;   // distance along the camera's axis
    float covered; // passes that saw a surface
    vec3 bias;     // of beauty, estimated
};

/// Sums over a run of passes, with the squared deviations between its batches; in the order of COLUMNS with everything
/// on.
struct PixelSum {
    Sample sum;
    vec3 fine;
    vec3 coarse;
    vec3 rest;    // what roundings took from the layers' sums
    float square; // of the luminance of the bias
};
const std::size_t PIXEL_FLOATS = sizeof(PixelSum) / sizeof(float);

/// What a pixel shows.
struct Pixel {
    Sample mean;     // over passes
    vec3 noise;      // standard error of the mean of beauty
    float biasNoise; // that of the luminance of the bias
};

} // namespace vkpm
