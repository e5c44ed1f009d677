/// PNG images from memory, by libpng.
#include "error.h"
#include "image/image.h"
#include "image/picture.h"
#include <bit>
#include <csetjmp>
#include <cstring>
#include <fmt/format.h>
#include <png.h>

namespace vkpm {
namespace {

/// What reading needs. Errors of libpng jump, past no object that has a destructor.
struct PngRead {
    std::string_view bytes;
    std::size_t place = 0;
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string error{};
    std::vector<unsigned char> texels{};
    std::vector<png_bytep> rows{};
    png_uint_32 width = 0, height = 0;
    bool deep = false;

    ~PngRead() { png_destroy_read_struct(&png, &info, nullptr); }
};

void readSome(png_structp png, png_bytep to, std::size_t count) {
    auto& read = *static_cast<PngRead*>(png_get_io_ptr(png));
    if (count > read.bytes.size() - read.place) png_error(png, "the file ends early");
    std::memcpy(to, read.bytes.data() + read.place, count);
    read.place += count;
}

[[noreturn]] void fail(png_structp png, png_const_charp message) {
    static_cast<PngRead*>(png_get_error_ptr(png))->error = message;
    std::longjmp(png_jmpbuf(png), 1);
}

/// Whether libpng had no error.
bool readHeader(PngRead& read) {
    if (setjmp(png_jmpbuf(read.png))) return false;
    png_set_user_limits(read.png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_malloc_max(read.png, 1 << 20);
    png_set_chunk_cache_max(read.png, 64);
    png_set_keep_unknown_chunks(read.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1); // all but those that matter
    png_set_option(read.png, PNG_SKIP_sRGB_CHECK_PROFILE, PNG_OPTION_ON);
    png_set_read_fn(read.png, &read, readSome);
    png_read_info(read.png, read.info);
    read.width = png_get_image_width(read.png, read.info);
    read.height = png_get_image_height(read.png, read.info);
    return true;
}

bool readTexels(PngRead& read) {
    if (setjmp(png_jmpbuf(read.png))) return false;
    png_read_image(read.png, read.rows.data());
    png_read_end(read.png, nullptr);
    return true;
}

/// Red, green, blue and alpha of 8 or 16 bits, whatever the file has.
bool askForRgba(PngRead& read) {
    if (setjmp(png_jmpbuf(read.png))) return false;
    read.deep = png_get_bit_depth(read.png, read.info) == 16;
    png_set_expand(read.png);
    png_set_gray_to_rgb(read.png);
    png_set_add_alpha(read.png, 0xffff, PNG_FILLER_AFTER);
    if (read.deep && std::endian::native == std::endian::little) png_set_swap(read.png);
    png_set_interlace_handling(read.png);
    png_read_update_info(read.png, read.info);
    return true;
}

Picture pictureOf(const PngRead& read) {
    Picture picture{.width = read.width, .height = read.height};
    const std::size_t count = std::size_t(read.width) * read.height;
    if (!read.deep) {
        picture.bytes.resize(count);
        for (std::size_t i = 0; i < count; i++) {
            const unsigned char* t = &read.texels[4 * i];
            picture.bytes[i] = t[0] | uint{t[1]} << 8 | uint{t[2]} << 16 | uint{t[3]} << 24;
        }
        return picture;
    }
    picture.floats.resize(count);
    for (std::size_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++) {
            std::uint16_t value = 0;
            std::memcpy(&value, &read.texels[8 * i + 2 * std::size_t(c)], 2);
            picture.floats[i][c] = static_cast<float>(value / 65535.0);
        }
    return picture;
}

} // namespace

Picture decodePng(std::string_view bytes) {
    PngRead read{bytes};
    const auto check = [&](bool good) {
        if (!good) throw InputError(fmt::format("cannot be read as a PNG image: {}", read.error));
    };
    read.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &read, fail, [](png_structp, png_const_charp) {});
    if (read.png) read.info = png_create_info_struct(read.png);
    if (!read.info) throw std::bad_alloc();
    check(readHeader(read));
    const std::uint64_t bits = png_get_bit_depth(read.png, read.info) * png_get_channels(read.png, read.info);
    const std::uint64_t bytesPerTexel = png_get_bit_depth(read.png, read.info) == 16 ? 16 : 4;
    requireTexels(read.width, read.height, bytesPerTexel, 4 * maxPictureTexels / bytesPerTexel);
    // Nothing is packed to less than a part in 1032, so that what is claimed is there before memory is taken for it.
    if (std::uint64_t{read.width} * read.height * bits / 8 / 1032 > bytes.size())
        throw InputError("cannot be read as a PNG image: the file ends early");
    check(askForRgba(read));
    const std::size_t row = png_get_rowbytes(read.png, read.info);
    if (row != std::size_t(read.width) * (read.deep ? 8 : 4))
        throw InputError("cannot be read as a PNG image: its rows have another length");
    read.texels.resize(row * read.height);
    for (std::size_t y = 0; y < read.height; y++) read.rows.push_back(read.texels.data() + y * row);
    check(readTexels(read));
    return pictureOf(read);
}

} // namespace vkpm
