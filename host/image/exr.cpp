/// OpenEXR images from memory.
#include "error.h"
#include "image/image.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace vkpm {
namespace {

class MemoryStream : public Imf::IStream {
public:
    explicit MemoryStream(std::string_view all) : Imf::IStream("image"), bytes(all) {}

    bool read(char to[], int count) override {
        if (count < 0 || place > bytes.size() || std::size_t(count) > bytes.size() - place)
            throw InputError("the file ends early");
        std::memcpy(to, bytes.data() + place, std::size_t(count));
        place += std::size_t(count);
        return place < bytes.size();
    }
    std::uint64_t tellg() override { return place; }
    void seekg(std::uint64_t to) override { place = to; }

private:
    std::string_view bytes;
    std::uint64_t place = 0;
};

/// The part that has colours, and its channels for red, green and blue.
struct Colors {
    int part;
    const char* names[3];
};

/// Colours of any part come before greys: these may be a mask or a depth. Y beside chroma is no grey.
Colors colorsOf(const Imf::MultiPartInputFile& file) {
    bool hasChroma = false;
    for (const Colors& wanted : {Colors{0, {"R", "G", "B"}}, Colors{0, {"Y", "Y", "Y"}}})
        for (int part = 0; part < file.parts(); part++) {
            const Imf::Header& header = file.header(part);
            if (header.hasType() && Imf::isDeepData(header.type())) continue;
            const auto find = [&](const char* name) { return header.channels().findChannel(name); };
            const auto has = [&](const char* name) {
                const Imf::Channel* channel = find(name);
                return channel && channel->xSampling == 1 && channel->ySampling == 1;
            };
            const bool chroma = find("RY") || find("BY");
            hasChroma |= chroma;
            if (!chroma && std::ranges::all_of(wanted.names, has))
                return {part, {wanted.names[0], wanted.names[1], wanted.names[2]}};
        }
    throw InputError(hasChroma ? "it has luminance and chroma, Y, RY and BY; allowed are R, G and B, or Y alone"
                               : "no part of it has channels R, G and B, or Y, with a value per texel");
}

Raster read(std::string_view bytes) {
    MemoryStream stream(bytes);
    Imf::MultiPartInputFile file(stream, 0);
    const Colors colors = colorsOf(file);
    const Imath::Box2i window = file.header(colors.part).dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1,
                       height = std::int64_t(window.max.y) - window.min.y + 1;
    requireTexels(std::uint64_t(std::max<std::int64_t>(width, 0)), std::uint64_t(std::max<std::int64_t>(height, 0)),
                  sizeof(vec3), maxTexels);
    Raster image{static_cast<uint>(width), static_cast<uint>(height),
                 std::vector<vec3>(std::size_t(width) * std::size_t(height))};
    const std::ptrdiff_t texel = sizeof(vec3), row = texel * std::ptrdiff_t(width);
    const bool grey = colors.names[0] == colors.names[1];
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < (grey ? 1u : 3u); c++) {
        const auto origin = reinterpret_cast<std::uintptr_t>(image.texels.data()) + c * sizeof(float) -
                            std::uintptr_t(texel * window.min.x) - std::uintptr_t(row * window.min.y);
        buffer.insert(colors.names[c],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(origin), std::size_t(texel), std::size_t(row)));
    }
    Imf::InputPart input(file, colors.part);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    if (grey)
        for (vec3& value : image.texels) value = vec3{value.x};
    return image;
}

} // namespace

bool isExr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

Raster decodeExr(std::string_view bytes) try { return read(bytes); } catch (const std::bad_alloc&) {
    throw;
} catch (const std::exception& error) {
    throw InputError(fmt::format("cannot be read as an EXR image: {}", error.what()));
}

} // namespace vkpm
