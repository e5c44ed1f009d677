/// JPEG images from memory, by libjpeg-turbo.
#include "error.h"
#include "image/image.h"
#include "image/picture.h"
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <jpeglib.h>

#include <jerror.h>

namespace vkpm {
namespace {

/// What reading needs. Errors of libjpeg jump, past no object that has a destructor.
struct JpegRead {
    jpeg_error_mgr errors{};
    jpeg_decompress_struct jpeg{};
    jpeg_progress_mgr progress{};
    std::jmp_buf jump{};
    char error[JMSG_LENGTH_MAX] = "";
    std::vector<uint> texels{};

    ~JpegRead() { jpeg_destroy_decompress(&jpeg); }
};

JpegRead& readOf(j_common_ptr jpeg) { return *static_cast<JpegRead*>(jpeg->client_data); }

[[noreturn]] void fail(j_common_ptr jpeg) {
    JpegRead& read = readOf(jpeg);
    read.errors.format_message(jpeg, read.error);
    std::longjmp(read.jump, 1);
}

/// A file that ends early is one that is damaged; other faults are passed over, as by other programs.
void warn(j_common_ptr jpeg, int level) {
    if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF) fail(jpeg);
}

/// Each scan of a progressive image is work for the whole of it.
void countScans(j_common_ptr jpeg) {
    JpegRead& read = readOf(jpeg);
    if (!jpeg->is_decompressor || read.jpeg.input_scan_number <= 100) return;
    std::strcpy(read.error, "it has more than 100 scans");
    std::longjmp(read.jump, 1);
}

bool readHeader(JpegRead& read, std::string_view bytes) {
    read.jpeg.err = jpeg_std_error(&read.errors);
    read.errors.error_exit = fail;
    read.errors.emit_message = warn;
    read.jpeg.client_data = &read;
    if (setjmp(read.jump)) return false;
    jpeg_create_decompress(&read.jpeg);
    read.jpeg.client_data = &read;
    read.progress.progress_monitor = countScans;
    read.jpeg.progress = &read.progress;
    jpeg_mem_src(&read.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&read.jpeg, TRUE);
    return true;
}

bool readTexels(JpegRead& read) {
    if (setjmp(read.jump)) return false;
    read.jpeg.out_color_space = JCS_EXT_RGBA;
    read.jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&read.jpeg);
    while (read.jpeg.output_scanline < read.jpeg.output_height) {
        auto* row = reinterpret_cast<JSAMPROW>(read.texels.data() +
                                               std::size_t{read.jpeg.output_scanline} * read.jpeg.output_width);
        jpeg_read_scanlines(&read.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&read.jpeg);
    return true;
}

} // namespace

Picture decodeJpeg(std::string_view bytes) {
    JpegRead read;
    const auto check = [&](bool good) {
        if (!good) throw InputError(fmt::format("cannot be read as a JPEG image: {}", read.error));
    };
    check(readHeader(read, bytes));
    const uint width = read.jpeg.image_width, height = read.jpeg.image_height;
    requireTexels(width, height, 4, maxPictureTexels);
    if (read.jpeg.num_components == 4)
        throw InputError("found a JPEG image of four inks; allowed are grey and red, green and blue");
    // Each block of 64 texels takes a bit at least, so that what is claimed is there before memory is taken for it.
    if (std::uint64_t{width} * height / 1024 > bytes.size())
        throw InputError("cannot be read as a JPEG image: the file ends early");
    read.texels.resize(std::size_t{width} * height);
    check(readTexels(read));
    return {width, height, std::move(read.texels)};
}

} // namespace vkpm
