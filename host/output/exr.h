/// Images in OpenEXR files.
#pragma once
#include "output/image.h"
#include <filesystem>

namespace vkpm {

/// Writes 32-bit float scanlines, ZIP compressed, linear Rec.709, and the attributes as strings named vkpm/...;
/// the file is replaced as a whole. Throws std::runtime_error with file and cause.
void writeExr(const std::filesystem::path& path, const Image& image);

/// The channels of an EXR file's data window as floats, in the order of their names, and its vkpm/ attributes.
/// Throws InputError with file and cause if it is missing, damaged or not a flat EXR image.
Image readExr(const std::filesystem::path& path);

/// The same without the values of its channels.
Image readExrHeader(const std::filesystem::path& path);

} // namespace vkpm
