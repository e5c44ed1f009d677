/// Display pixels in PNG files (ISO/IEC 15948), with libdeflate in place of stb's own, slow deflate.
#include "output/png.h"
#include "output/atomic_file.h"
#include <array>
#include <cassert>
#include <cstdlib>
#include <libdeflate.h>
#include <memory>
#include <new>
#include <string_view>

namespace vkpm {
namespace {

using Bytes = std::vector<unsigned char>;

void appendNumber(std::vector<char>& png, std::uint32_t number) {
    for (const int shift : {24, 16, 8, 0}) png.push_back(static_cast<char>(number >> shift & 255u));
}

void appendChunk(std::vector<char>& png, std::string_view type, const Bytes& data) {
    appendNumber(png, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = png.size();
    png.insert(png.end(), type.begin(), type.end());
    png.insert(png.end(), data.begin(), data.end());
    appendNumber(png, libdeflate_crc32(0, png.data() + begin, png.size() - begin));
}

/// The predictor of PNG's filter 4.
int paeth(int left, int up, int corner) {
    const int p = left + up - corner;
    const int a = std::abs(p - left), b = std::abs(p - up), c = std::abs(p - corner);
    return a <= b && a <= c ? left : b <= c ? up : corner;
}

/// Rows of `channels` bytes a pixel, 3 or 4, each with a byte before it that says by which filter it was predicted:
/// none, left, up, or Paeth's, whichever leaves the least sum of differences.
Bytes filtered(uvec2 size, std::span<const uint> rgba8, std::size_t channels) {
    const std::size_t width = channels * std::size_t(size.x);
    Bytes result, before(width + channels, 0), row(width + channels, 0); // zeros to the left
    result.reserve((width + 1) * size.y);
    std::array<Bytes, 4> tried;
    for (Bytes& bytes : tried) bytes.resize(width);
    for (std::size_t y = 0; y < size.y; y++) {
        for (std::size_t x = 0; x < size.x; x++)
            for (std::size_t c = 0; c < channels; c++)
                row[channels + channels * x + c] = static_cast<unsigned char>(rgba8[y * size.x + x] >> 8 * c & 255u);
        std::array<std::uint64_t, 4> sums{};
        for (std::size_t i = 0; i < width; i++) {
            const std::array<int, 4> predicted{0, row[i], before[i + channels],
                                               paeth(row[i], before[i + channels], before[i])};
            for (std::size_t f = 0; f < 4; f++) {
                tried[f][i] = static_cast<unsigned char>(row[i + channels] - predicted[f]);
                sums[f] += static_cast<std::uint64_t>(std::abs(static_cast<signed char>(tried[f][i])));
            }
        }
        const auto best = static_cast<std::size_t>(std::ranges::min_element(sums) - sums.begin());
        result.push_back(static_cast<unsigned char>(std::array{0, 1, 2, 4}[best]));
        result.insert(result.end(), tried[best].begin(), tried[best].end());
        std::swap(before, row);
    }
    return result;
}

Bytes deflated(const Bytes& raw) {
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(6), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    Bytes small(libdeflate_zlib_compress_bound(compressor.get(), raw.size()));
    small.resize(libdeflate_zlib_compress(compressor.get(), raw.data(), raw.size(), small.data(), small.size()));
    return small;
}

} // namespace

std::vector<char> encodePng(uvec2 size, std::span<const uint> rgba8, bool alpha) {
    assert(rgba8.size() == size_t(size.x) * size.y);
    Bytes header;
    for (const uint side : {size.x, size.y})
        for (const uint shift : {24u, 16u, 8u, 0u}) header.push_back(static_cast<unsigned char>(side >> shift & 255u));
    header.insert(header.end(), {8, static_cast<unsigned char>(alpha ? 6 : 2), 0, 0,
                                 0}); // bits, RGB or RGBA, deflate, filters by row, not interlaced
    constexpr std::string_view SIGNATURE = "\x89PNG\r\n\x1a\n";
    std::vector<char> png(SIGNATURE.begin(), SIGNATURE.end());
    appendChunk(png, "IHDR", header);
    appendChunk(png, "IDAT", deflated(filtered(size, rgba8, alpha ? 4 : 3)));
    appendChunk(png, "IEND", {});
    return png;
}

void writePng(const std::filesystem::path& path, uvec2 size, std::span<const uint> rgba8, bool alpha) {
    replaceFile(path, encodePng(size, rgba8, alpha));
}

} // namespace vkpm
