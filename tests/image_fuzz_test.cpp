/// Thousands of damaged images of each format: each is read whole or refused, at once and in little memory.
#include "error.h"
#include "image/picture.h"
#include "images.h"
#include "judge.h"
#include "scene_text.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <ctime>
#include <fstream>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/resource.h>

namespace vkpm {
namespace {

#ifdef NDEBUG
constexpr double maxSeconds = 2; // of processor time
constexpr std::uint64_t inputsByDefault = 10'000;
#else
constexpr double maxSeconds = 10; // sanitizers, and other work on the machine
constexpr std::uint64_t inputsByDefault = 500;
#endif

std::uint64_t setting(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

// What a file of floats may claim are 768 MiB; they are set aside before it shows that it has fewer.
constexpr double maxMiB = 1024;

constexpr uint width = 32, height = 24;

std::vector<float> gradient() {
    std::vector<float> values;
    for (uint i = 0; i < width * height; i++) values.push_back(1 + float(i % 7) + 0.01f * float(i / width));
    return values;
}

/// The bytes of an OpenEXR file, in scanlines or in tiles.
std::string exrBytes(Imf::Compression compression, bool tiled) {
    std::vector<float> values = gradient();
    Imf::Header header(width, height, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * width));
    }
    const std::string path = writeScene("", "sound.exr");
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(16, 16));
        Imf::TiledOutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    }
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The bytes of a Radiance file: texels as they are, with repeated texels, or each component in runs.
std::string hdrBytes(int kind) {
    std::string bytes = "#?RADIANCE\nEXPOSURE=1.5\nFORMAT=32-bit_rle_rgbe\n\n-Y 24 +X 32\n";
    for (uint y = 0; y < height; y++) {
        if (kind == 2) bytes += {2, 2, 0, char(width)};
        if (kind == 2)
            for (int component = 0; component < 4; component++) {
                bytes += {char(128 + 16), char(90 + y)}; // sixteen times the same, then sixteen by themselves
                bytes += char(16);
                for (uint x = 0; x < 16; x++) bytes += char(component < 3 ? 7 * x + y : 128);
            }
        for (uint x = 0; kind < 2 && x < (kind == 1 ? 16 : width); x++) {
            bytes += {char(9 * x + 2), char(y + 3), char(99), char(126 + x % 4)};
            if (kind == 1) bytes += {1, 1, 1, 1};
        }
    }
    return bytes;
}

std::vector<std::string> soundPngs() {
    std::vector<unsigned char> texels(width * height * 4);
    for (std::size_t i = 0; i < texels.size(); i++) texels[i] = static_cast<unsigned char>(i * i % 64);
    return {pngBytes(width, height, texels), pngBytes(8, 8, std::vector<std::uint16_t>(8 * 8 * 4, 1000))};
}

std::vector<std::string> soundJpegs() {
    const std::vector<unsigned char> texels(width * height * 3, 99);
    return {jpegBytes(width, height, texels), jpegBytes(width, height, texels, true)};
}

std::vector<std::string> soundExrs() {
    std::vector<std::string> files{exrBytes(Imf::ZIP_COMPRESSION, true)};
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
          Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
        files.push_back(exrBytes(compression, false));
    return files;
}

/// Puts the checksums of a PNG's chunks right, so that what they hold is looked at.
void repairChecksums(std::string& png) {
    const auto number = [&](std::size_t place) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; i++) value = value << 8 | static_cast<unsigned char>(png[place + i]);
        return value;
    };
    for (std::size_t place = 8; place + 12 <= png.size();) {
        const std::size_t length = number(place), end = place + 8 + length;
        if (end + 4 > png.size()) return;
        const std::uint32_t sum = libdeflate_crc32(0, png.data() + place + 4, 4 + length);
        for (std::size_t i = 0; i < 4; i++) png[end + i] = static_cast<char>(sum >> (24 - 8 * i));
        place = end + 4;
    }
}

double peakMiB() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024;
}

/// Damages files in one to eight places, or cuts them.
void expectReadOrRefused(const char* format, const std::vector<std::string>& sound) {
    for (const std::string& bytes : sound) EXPECT_NO_THROW(decodePicture(bytes)) << format;
    Random random(static_cast<uint>(setting("VKPM_FUZZ_SEED", 7)));
    const std::uint64_t count = setting("VKPM_FUZZ_INPUTS", inputsByDefault);
    uint read = 0, refused = 0;
    double longest = 0;
    const double before = peakMiB();
    for (std::uint64_t i = 0; i < count; i++) {
        std::string bytes = sound[i % sound.size()];
        if (random.bits() % 8 == 0) bytes.resize(random.bits() % bytes.size());
        const std::size_t within = random.bits() % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400);
        for (uint k = 0, n = 1 + random.bits() % 8; k < n && !bytes.empty(); k++)
            bytes[random.bits() % within] = static_cast<char>(random.bits());
        if (bytes.starts_with("\x89PNG") && random.bits() % 4) repairChecksums(bytes);
        const std::clock_t start = std::clock();
        try {
            const Picture picture = decodePicture(bytes);
            ASSERT_EQ(picture.bytes.size() + picture.floats.size(), std::size_t{picture.width} * picture.height);
            read++;
        } catch (const InputError&) {
            refused++;
        }
        const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
        EXPECT_LT(seconds, maxSeconds) << format << " " << i;
        longest = std::max(longest, seconds);
    }
    const double memory = peakMiB() - before;
    std::printf("%s: %u read, %u refused, %.3g s and %.0f MiB at most\n", format, read, refused, longest, memory);
    EXPECT_LT(memory, maxMiB) << format;
    EXPECT_GT(read, count / 100);
    EXPECT_GT(refused, count / 100);
}

TEST(ImageFuzz, DamagedImagesAreReadOrRefused) {
    expectReadOrRefused("PNG", soundPngs());
    expectReadOrRefused("JPEG", soundJpegs());
    expectReadOrRefused("Radiance", {hdrBytes(0), hdrBytes(1), hdrBytes(2)});
    expectReadOrRefused("OpenEXR", soundExrs());
}

} // namespace
} // namespace vkpm
