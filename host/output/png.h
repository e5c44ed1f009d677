/// Display pixels in PNG files.
#pragma once
#include "shared.h"
#include <filesystem>
#include <span>
#include <vector>

namespace vkpm {

/// The bytes of a PNG file of 8-bit sRGB pixels, as writePng takes them.
std::vector<char> encodePng(uvec2 size, std::span<const uint> rgba8, bool alpha = false);

/// Writes 8-bit sRGB pixels, row by row from the top, red in the lowest byte; the fourth byte is left out without
/// `alpha`. The file is replaced as a whole. Throws std::runtime_error with file and cause.
void writePng(const std::filesystem::path& path, uvec2 size, std::span<const uint> rgba8, bool alpha = false);

} // namespace vkpm
