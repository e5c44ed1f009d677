/// The film as an image with the layers and features that users find in the EXR file.
#pragma once
#include "output/image.h"
#include "render/pixel.h"
#include "scene/settings.h"
#include <span>

namespace vkpm {

/// Beauty (R G B, the sum of the layers of light), and of the layers asked for (bits by place in layerNames): the five
/// of light, albedo, normal, depth.Z (mean over the samples that saw a surface, 0 where none did) and noise (standard
/// error of beauty). `pixels` are row by row from the top, size.x * size.y of them; radiance in W/(m^2 sr), depth in
/// world units.
/// With `alpha` also A, the part of a pixel that a surface covers.
Image filmImage(std::span<const Pixel> pixels, uvec2 size, uint layers, bool alpha = false);

/// The sum of a pixel's layers of light.
vec3 beauty(const Pixel& pixel);

/// A linear value as 8-bit sRGB (IEC 61966-2-1); what is below 0 or above 1 as these.
uint encodeSrgb(float linear);

/// Beauty as 8-bit sRGB (IEC 61966-2-1) under an exposure in stops, red in the lowest byte. With `alpha` the highest
/// byte is what is covered, and colours are those of that part; else it is 255.
std::vector<uint> develop(std::span<const Pixel> pixels, float exposure, bool alpha = false);

/// The exposure that shows the mean logarithm of what is not black as a middle grey of 0.18, in hundredths of a stop.
class AutoExposure {
public:
    void add(std::span<const Pixel> pixels);
    float stops() const;

private:
    double sum = 0;
    std::uint64_t count = 0;
};

/// The exposure of a picture: what the settings say, or what shows it.
float exposureOf(const Settings& settings, std::span<const Pixel> pixels);

} // namespace vkpm
