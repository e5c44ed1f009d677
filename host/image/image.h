/// Images that a scene reads, in memory: decoded from the bytes of their files.
#pragma once
#include "shared.h"
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

/// Linear colours, row by row, the top row first. (Image, in output/, is what a render writes.)
struct Raster {
    uint width = 0, height = 0;
    std::vector<vec3> texels{};
};

const std::uint64_t maxTexels = 1ull << 26;     // of an image: 768 MiB of floats
const std::uint64_t maxImageBytes = 2ull << 30; // of its file

/// Throws InputError, without a file's name, unless an image has 1 to `most` texels, each of so many bytes.
void requireTexels(std::uint64_t width, std::uint64_t height, std::uint64_t bytesPerTexel, std::uint64_t most);

/// How many texels have a component that is negative or not finite, and the first of them, in words; empty if none has.
std::string badTexels(const Raster& image);

/// OpenEXR: R, G and B of the first flat part that has them, else Y of the first for all three. Throws InputError,
/// without a file's name.
Raster decodeExr(std::string_view bytes);

/// Radiance RGBE, with either run-length code or none. Throws InputError, without a file's name.
Raster decodeHdr(std::string_view bytes);

bool isExr(std::string_view bytes);
bool isHdr(std::string_view bytes);

} // namespace vkpm
