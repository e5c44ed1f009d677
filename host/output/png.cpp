/// Display pixels in PNG files.
#include "output/png.h"
#include "output/atomic_file.h"
#include <cassert>
#include <stb_image_write.h>
#include <stdexcept>

namespace vkpm {
namespace {

void append(void* bytes, void* data, int count) {
    const char* first = static_cast<const char*>(data);
    static_cast<std::vector<char>*>(bytes)->insert(static_cast<std::vector<char>*>(bytes)->end(), first, first + count);
}

} // namespace

std::vector<char> encodePng(uvec2 size, std::span<const uint> rgba8) {
    assert(rgba8.size() == size_t(size.x) * size.y);
    std::vector<unsigned char> rgb;
    rgb.reserve(3 * rgba8.size());
    for (const uint color : rgba8)
        for (const uint shift : {0u, 8u, 16u}) rgb.push_back(static_cast<unsigned char>(color >> shift & 255u));

    std::vector<char> bytes;
    const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
    if (!stbi_write_png_to_func(append, &bytes, width, height, 3, rgb.data(), 3 * width))
        throw std::runtime_error("stbi_write_png_to_func: out of memory");
    return bytes;
}

void writePng(const std::filesystem::path& path, uvec2 size, std::span<const uint> rgba8) { replaceFile(path, encodePng(size, rgba8)); }

} // namespace vkpm
