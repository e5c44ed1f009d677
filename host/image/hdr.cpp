/// Radiance's RGBE images from memory (Ward 1991, "Real Pixels", Graphics Gems II).
#include "error.h"
#include "image/image.h"
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace vkpm {
namespace {

using Rgbe = glm::vec<4, unsigned char>;

class HdrBytes {
public:
    explicit HdrBytes(std::string_view all) : bytes(all) {}

    unsigned char byte() {
        if (place >= bytes.size()) throw InputError("the file ends early");
        return static_cast<unsigned char>(bytes[place++]);
    }
    Rgbe four() {
        Rgbe four{};
        for (int i = 0; i < 4; i++) four[i] = byte();
        return four;
    }
    std::string_view line() {
        const std::size_t end = bytes.find('\n', place);
        if (end == std::string_view::npos) throw InputError("the file ends early");
        std::string_view line = bytes.substr(place, end - place);
        place = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

private:
    std::string_view bytes;
    std::size_t place = 0;
};

std::optional<double> number(std::string_view text) {
    double value = 0;
    while (text.starts_with(' ')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !(value > 0) || !std::isfinite(value)) return {};
    return value;
}

/// The product of the exposures that were applied to the values, which end the header with an empty line.
double readHeader(HdrBytes& bytes) {
    double exposure = 1;
    for (std::string_view line = bytes.line(); !line.empty(); line = bytes.line()) {
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            throw InputError("its FORMAT is another than 32-bit_rle_rgbe, which alone is allowed");
        if (!line.starts_with("EXPOSURE=")) continue;
        const auto factor = number(line.substr(9));
        if (!factor) throw InputError("its EXPOSURE is no number above 0");
        exposure *= *factor;
    }
    return exposure;
}

struct Resolution {
    std::uint64_t height = 0, width = 0;
    bool up = false, left = false; // where rows and columns go
};

/// "-Y 512 +X 1024"
Resolution readResolution(std::string_view line) {
    const auto refuse = [] {
        throw InputError("its line of resolution is none of rows, such as -Y 512 +X 1024, which alone are allowed");
    };
    const std::size_t second = line.find('X');
    if (line.size() < 4 || line[1] != 'Y' || second == std::string_view::npos || second < 4) refuse();
    const char signs[2]{line[0], line[second - 1]};
    const auto height = number(line.substr(2, second - 4)), width = number(line.substr(second + 1));
    for (const char sign : signs)
        if (sign != '+' && sign != '-') refuse();
    if (!height || !width || *height > 1e9 || *width > 1e9) refuse();
    return {std::uint64_t(*height), std::uint64_t(*width), signs[0] == '+', signs[1] == '-'};
}

/// A row whose components follow each other, each in runs.
void readRuns(HdrBytes& bytes, std::vector<Rgbe>& row) {
    for (int component = 0; component < 4; component++)
        for (std::size_t x = 0; x < row.size();) {
            const unsigned code = bytes.byte();
            const std::size_t count = code > 128 ? code - 128 : code;
            if (count == 0 || count > row.size() - x) throw InputError("a run is longer than its row");
            unsigned char value = code > 128 ? bytes.byte() : 0;
            for (std::size_t i = 0; i < count; i++) {
                if (code <= 128) value = bytes.byte();
                row[x++][component] = value;
            }
        }
}

/// A row of texels from `first` on, where three ones and a count repeat the one before.
void readTexels(HdrBytes& bytes, std::vector<Rgbe>& row, Rgbe first) {
    Rgbe texel = first;
    for (std::size_t x = 0, shift = 0;;) {
        if (texel.x == 1 && texel.y == 1 && texel.z == 1) {
            const std::uint64_t count = shift < 32 ? std::uint64_t{texel.w} << shift : ~std::uint64_t{0};
            if (x == 0 || count > row.size() - x) throw InputError("a run is longer than its row");
            for (std::uint64_t i = 0; i < count; i++, x++) row[x] = row[x - 1];
            shift += 8;
        } else {
            row[x++] = texel;
            shift = 0;
        }
        if (x == row.size()) return;
        texel = bytes.four();
    }
}

} // namespace

bool isHdr(std::string_view bytes) { return bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE"); }

Raster decodeHdr(std::string_view all) try {
    HdrBytes bytes(all);
    const double exposure = readHeader(bytes);
    const Resolution size = readResolution(bytes.line());
    requireTexels(size.width, size.height, sizeof(vec3), maxTexels);
    if (all.size() < size.height * 4) throw InputError("the file ends early");
    Raster image{static_cast<uint>(size.width), static_cast<uint>(size.height), {}};
    image.texels.resize(size.width * size.height);
    std::vector<Rgbe> row(size.width);
    for (std::size_t y = 0; y < size.height; y++) {
        const Rgbe first = bytes.four();
        const bool runs = size.width >= 8 && size.width < 32768 && first.x == 2 && first.y == 2 && first.z < 128;
        if (!runs) readTexels(bytes, row, first);
        else if (std::size_t(first.z) * 256 + first.w != size.width) throw InputError("a row has another width");
        else readRuns(bytes, row);
        vec3* to = image.texels.data() + (size.up ? size.height - 1 - y : y) * size.width;
        for (std::size_t x = 0; x < size.width; x++) {
            const Rgbe texel = row[size.left ? size.width - 1 - x : x];
            const double scale = texel.w == 0 ? 0 : std::ldexp(1 / exposure, texel.w - 136);
            to[x] = vec3{glm::dvec3{texel.x, texel.y, texel.z} * scale};
        }
    }
    return image;
} catch (const InputError& error) {
    throw InputError(fmt::format("cannot be read as a Radiance image: {}", error.what()));
}

} // namespace vkpm
