/// Images of less usual forms, as other programs write them.
#include "error.h"
#include "image/image.h"
#include "image/picture.h"
#include "images.h"
#include "scene/text.h"
#include "scene_text.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>

namespace vkpm {
namespace {

struct ExrChannel {
    const char* name;
    double value; // of the first texel, one more for each further one
    Imf::PixelType type = Imf::FLOAT;
    int sampling = 1;
};

const int exrWidth = 4, exrHeight = 2;

/// Parts of 4 x 2 texels, in scanlines, whose first texel lies at a place of the picture.
std::string exrOf(const std::vector<std::vector<ExrChannel>>& parts, Imath::V2i corner = {0, 0}) {
    const Imath::Box2i window{corner, corner + Imath::V2i{exrWidth - 1, exrHeight - 1}};
    std::vector<Imf::Header> headers;
    for (const std::vector<ExrChannel>& part : parts) {
        Imf::Header& header = headers.emplace_back(Imath::Box2i{{0, 0}, {99, 99}}, window);
        header.setName(fmt::format("part {}", headers.size()));
        header.setType(Imf::SCANLINEIMAGE);
        for (const ExrChannel& c : part) header.channels().insert(c.name, Imf::Channel(c.type, c.sampling, c.sampling));
    }
    const std::string path = writeScene("", "image.exr");
    {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
        for (std::size_t i = 0; i < parts.size(); i++) {
            std::vector<std::vector<unsigned char>> planes;
            Imf::FrameBuffer buffer;
            for (const ExrChannel& c : parts[i]) {
                const std::size_t size = c.type == Imf::HALF ? 2 : 4;
                std::vector<unsigned char>& plane = planes.emplace_back(size * exrWidth * exrHeight);
                for (int k = 0; k < exrWidth * exrHeight; k++) {
                    const auto put = [&](auto value) { std::memcpy(&plane[std::size_t(k) * size], &value, size); };
                    if (c.type == Imf::HALF) put(Imath::half(static_cast<float>(c.value + k)));
                    else if (c.type == Imf::UINT) put(static_cast<unsigned>(c.value + k));
                    else put(static_cast<float>(c.value + k));
                }
                buffer.insert(c.name, Imf::Slice::Make(c.type, plane.data(), window, size, size * exrWidth, c.sampling,
                                                       c.sampling));
            }
            Imf::OutputPart output(file, int(i));
            output.setFrameBuffer(buffer);
            output.writePixels(exrHeight);
        }
    }
    return readBytes(path, 1 << 20, "");
}

void expectTexels(const std::string& bytes, vec3 first) {
    const Raster image = decodeExr(bytes);
    ASSERT_EQ(image.width, uint(exrWidth));
    ASSERT_EQ(image.height, uint(exrHeight));
    for (int i = 0; i < exrWidth * exrHeight; i++) EXPECT_EQ(image.texels[std::size_t(i)], first + float(i)) << i;
}

TEST(Image, ExrMayHaveOtherNumbersAndWindows) {
    for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF, Imf::UINT})
        for (const Imath::V2i& corner : {Imath::V2i{0, 0}, Imath::V2i{7, -5}})
            expectTexels(exrOf({{{"A", 50, type}, {"B", 30, type}, {"G", 20, type}, {"R", 10, type}}}, corner),
                         {10, 20, 30});
    expectTexels(exrOf({{{"Y", 3}, {"Z", 9}}}), vec3(3));
}

TEST(Image, ExrColoursComeBeforeGreysOfOtherParts) {
    expectTexels(exrOf({{{"Y", 1}}, {{"Z", 4}}, {{"B", 30}, {"G", 20}, {"R", 10}}}), {10, 20, 30});
    expectTexels(exrOf({{{"Z", 4}}, {{"Y", 1}}}), vec3(1));
}

TEST(Image, ExrOfChromaIsNoGrey) {
    const std::string bytes = exrOf({{{"BY", 0.1, Imf::HALF, 2}, {"RY", 0.2, Imf::HALF, 2}, {"Y", 1, Imf::HALF}}});
    try {
        (void)decodeExr(bytes);
        FAIL() << "was read";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("R, G and B, or Y alone"));
    }
}

/// A PNG file of rows as they are in the file.
std::string pngOf(uint width, uint height, int depth, int color, int interlace, std::vector<unsigned char> rows) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp from, png_bytep data, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(from))->append(reinterpret_cast<char*>(data), count);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, depth, color, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    std::vector<png_bytep> starts;
    for (uint y = 0; y < height; y++) starts.push_back(rows.data() + y * (rows.size() / height));
    png_write_image(png, starts.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

TEST(Image, PngMayBeInterlacedOrGreyWithOpacity) {
    std::vector<unsigned char> rows;
    for (uint i = 0; i < 9 * 5 * 3; i++) rows.push_back(static_cast<unsigned char>(7 * i));
    const Picture plain = decodePng(pngOf(9, 5, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, rows)),
                  interlaced = decodePng(pngOf(9, 5, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, rows));
    ASSERT_EQ(plain.bytes.size(), 45u);
    EXPECT_EQ(plain.bytes[1], 21u | 28u << 8 | 35u << 16 | 255u << 24);
    EXPECT_EQ(interlaced.bytes, plain.bytes);

    const Picture grey = decodePng(
        pngOf(2, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE, {0x80, 0, 0xff, 0xff, 0x12, 0x34, 0, 1}));
    ASSERT_EQ(grey.floats.size(), 2u);
    EXPECT_EQ(grey.floats[0], vec4(vec3(0x8000 / 65535.0f), 1));
    EXPECT_EQ(grey.floats[1], vec4(vec3(0x1234 / 65535.0f), 1 / 65535.0f));

    const Picture bits = decodePng(pngOf(8, 1, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, {0xa0}));
    ASSERT_EQ(bits.bytes.size(), 8u);
    EXPECT_EQ(bits.bytes[0], 0xffffffffu);
    EXPECT_EQ(bits.bytes[1], 0xff000000u);
}

TEST(Image, JpegMayComeInScans) {
    std::vector<unsigned char> rgb;
    for (uint i = 0; i < 16 * 16 * 3; i++) rgb.push_back(static_cast<unsigned char>(i / 3));
    EXPECT_EQ(decodeJpeg(jpegBytes(16, 16, rgb, true)).bytes, decodeJpeg(jpegBytes(16, 16, rgb)).bytes);
}

} // namespace
} // namespace vkpm
