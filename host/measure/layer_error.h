/// How far a layer is off a reference.
#pragma once
#include "measure/image_layers.h"

namespace vkpm {

/// Error measures over the pixels that are finite in both images, in the layer's unit where none is said. NaN stands
/// for what cannot be said: all of them if there is no such pixel, flip unless the layer is a colour.
struct LayerError {
    double rmse = 0;              // sqrt(mean((x - r)^2)) over pixels and channels; x image, r reference
    double relmse = 0;            // mean((x - r)^2 / (r^2 + 0.01)), no unit
    double error = 0;             // the root of relmse over the values that keptValues() keeps, as renders state it
    double meanError = 0;         // mean(x - r): positive if the image is too bright
    double meanRelativeError = 0; // mean(|x - r| / (|r| + 0.01)), no unit
    double maxError = 0;          // the greatest |x - r|
    double flip = 0;              // mean of flipMap over all pixels, 0 to 1
    std::uint64_t nonfinite = 0;  // pixels that are not finite in one of the images
};

/// The same for people.
inline constexpr const char* MEASURES =
    R"(Measures over the pixels and channels of a layer, in its unit; x is the image's value, r the reference's:
  rmse                 sqrt(mean((x - r)^2))
  relmse               mean((x - r)^2 / (r^2 + 0.01)), no unit
  error                sqrt(relmse) of the 98 % of the values that are off least, as a render states it
  mean error           mean(x - r); positive: the image is too bright
  mean relative error  mean(|x - r| / (|r| + 0.01)), no unit
  max error            the greatest |x - r|
  flip                 mean HDR-FLIP, of colours alone: 0 (they look alike) to 1
  nonfinite            pixels that are NaN or infinite in one of the files: left out, for flip alike)";

/// The root of the mean of squared errors over those that keptValues() keeps.
double keptError(const std::vector<float>& squares);

/// The error of a layer against one that is comparable and of the same size.
LayerError measureLayer(const Layer& image, const Layer& reference);

} // namespace vkpm
