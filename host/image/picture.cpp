/// Formats of images and their limits.
#include "image/picture.h"
#include "error.h"
#include "image/image.h"
#include <fmt/format.h>

namespace vkpm {

static Picture pictureOf(const Raster& raster) {
    if (const std::string bad = badTexels(raster); !bad.empty()) throw InputError(bad);
    Picture picture{.width = raster.width, .height = raster.height, .linear = true};
    picture.floats.reserve(raster.texels.size());
    for (const vec3& texel : raster.texels) picture.floats.emplace_back(texel, 1);
    return picture;
}

Picture decodePicture(std::string_view bytes) {
    if (bytes.starts_with("\x89PNG")) return decodePng(bytes);
    if (bytes.starts_with("\xff\xd8")) return decodeJpeg(bytes);
    if (isExr(bytes)) return pictureOf(decodeExr(bytes));
    if (isHdr(bytes)) return pictureOf(decodeHdr(bytes));
    using namespace std::literals;
    const bool webp = bytes.starts_with("RIFF") && bytes.substr(8).starts_with("WEBP");
    const bool ktx = bytes.starts_with("\xabKTX"sv);
    throw InputError(
        fmt::format("found {}; allowed is a PNG, JPEG, OpenEXR or Radiance image", bytes.empty() ? "an empty file"
                                                                                   : webp        ? "a WebP image"
                                                                                   : ktx         ? "a KTX image"
                                                                                         : "an unknown format"));
}

} // namespace vkpm
