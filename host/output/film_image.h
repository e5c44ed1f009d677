/// The film as an image with the layers and features that users find in the EXR file.
#pragma once
#include "output/image.h"
#include <span>

namespace vkpm {

/// Beauty (R G B, the sum of the layers), the five layers, albedo, normal, depth.Z (mean over the samples that saw a
/// surface, 0 where none did) and noise (standard error of beauty's mean over passes, 0 below two passes).
/// `pixels` are row by row from the top, size.x * size.y of them; radiance in W/(m^2 sr), depth in world units.
Image filmImage(std::span<const Pixel> pixels, uvec2 size, uint passes);

} // namespace vkpm
