/// Images as textures keep them: 8 bits a channel as they are, all else as floats.
#pragma once
#include "shared.h"
#include <string_view>
#include <vector>

namespace vkpm {

/// Row by row, the top row first; one of the two arrays has the texels.
struct Picture {
    uint width = 0, height = 0;
    std::vector<uint> bytes{};  // red in the low byte, alpha in the high one
    std::vector<vec4> floats{}; // fractions of PNG's 65535, or what OpenEXR and Radiance hold
    bool linear = false;        // OpenEXR or Radiance
};

const std::uint64_t maxPictureTexels = 1ull << 28; // of an image of 8 bits: 1 GiB; of floats a quarter

/// The image of a PNG, JPEG, OpenEXR or Radiance file, which its first bytes say. Colour profiles are left aside.
/// Throws InputError, without a file's name.
Picture decodePicture(std::string_view bytes);

Picture decodePng(std::string_view bytes);
Picture decodeJpeg(std::string_view bytes);

} // namespace vkpm
