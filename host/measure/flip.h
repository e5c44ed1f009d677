/// How far one image differs from another to the eye.
#pragma once
#include "measure/image_layers.h"

namespace vkpm {

/// HDR-FLIP of each pixel, row by row, from 0 (alike) to 1: how far an image differs from its reference to an observer
/// who flips between them, at 67 pixels per degree, the worst of several exposures. Both are colours, linear Rec.709,
/// of one size. A pixel that is not finite in one of them counts as alike. Andersson et al., FLIP: a difference
/// evaluator for alternating images, 2020; the same, Visualizing errors in rendered high dynamic range images, 2021.
std::vector<float> flipMap(const Layer& image, const Layer& reference);

} // namespace vkpm
