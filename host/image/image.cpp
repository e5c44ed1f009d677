/// Limits and values of images.
#include "image/image.h"
#include "error.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {

void requireTexels(std::uint64_t width, std::uint64_t height, std::uint64_t bytesPerTexel, std::uint64_t most) {
    if (width < 1 || height < 1 || width > most / height)
        throw InputError(fmt::format("found {} x {} texels, {:.3g} MiB; allowed are 1 to {}, {} MiB", width, height,
                                     double(bytesPerTexel) * double(width) * double(height) / 1048576, most,
                                     bytesPerTexel * most >> 20));
}

std::string badTexels(const Raster& image) {
    const auto bad = [](const vec3& texel) {
        return !(std::min({texel.x, texel.y, texel.z}) >= 0 && std::isfinite(texel.x + texel.y + texel.z));
    };
    const auto count = std::ranges::count_if(image.texels, bad);
    if (count == 0) return "";
    const auto first = std::ranges::find_if(image.texels, bad);
    const auto index = static_cast<std::size_t>(first - image.texels.begin());
    return fmt::format("{} texels are negative or not finite, the first, ({}, {}, {}), in row {}, column {}, from 0",
                       count, first->x, first->y, first->z, index / image.width, index % image.width);
}

} // namespace vkpm
