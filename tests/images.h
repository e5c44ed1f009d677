/// Images for tests, as bytes of PNG and JPEG files.
#pragma once
#include "shared.h"
#include <cstdlib>
#include <png.h>
#include <stdexcept>
#include <string>
#include <vector>

#include <cstdio>

#include <jpeglib.h>

namespace vkpm {

/// Of four numbers a texel: of 8 bits by the curve of sRGB, of 16 bits linear.
template <class T> std::string pngBytes(uint width, uint height, const std::vector<T>& rgba) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = sizeof(T) == 1 ? PNG_FORMAT_RGBA : PNG_FORMAT_LINEAR_RGB_ALPHA;
    png_alloc_size_t size = 0;
    if (!png_image_write_to_memory(&image, nullptr, &size, 0, rgba.data(), 0, nullptr))
        throw std::runtime_error(image.message);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr))
        throw std::runtime_error(image.message);
    bytes.resize(size);
    return bytes;
}

/// One opaque texel.
inline std::string greyPng(unsigned char grey) { return pngBytes<unsigned char>(1, 1, {grey, grey, grey, 255}); }

inline std::string jpegBytes(uint width, uint height, std::vector<unsigned char> rgb, bool progressive = false) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* to = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &to, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < height) {
        JSAMPROW row = rgb.data() + std::size_t{3} * width * jpeg.next_scanline;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string bytes(reinterpret_cast<char*>(to), size);
    std::free(to);
    return bytes;
}

} // namespace vkpm
