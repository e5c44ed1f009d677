/// Images in OpenEXR files.
#include "output/exr.h"
#include "output/atomic_file.h"
#include "gpu/error.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <string_view>
#include <thread>

namespace vkpm {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view PREFIX = "vkpm/";
constexpr std::int64_t MAX_PIXELS = std::int64_t(1) << 28;

/// A file in memory, so that what can fail about disks fails in one place.
class MemoryStream : public Imf::OStream {
public:
    explicit MemoryStream(const std::string& name) : OStream(name.c_str()) {}

    void write(const char bytes[], int count) override {
        const size_t end = position + static_cast<size_t>(count);
        if (end > content.size()) content.resize(end);
        std::copy_n(bytes, count, content.begin() + static_cast<std::ptrdiff_t>(position));
        position = end;
    }
    std::uint64_t tellp() override { return position; }
    void seekp(std::uint64_t to) override { position = to; }

    std::vector<char> content;

private:
    size_t position = 0;
};

/// A view of an image's values that OpenEXR reads from or writes to; `origin` is the data window's corner.
Imf::Slice slice(const float* values, uvec2 size, Imath::V2i origin) {
    const size_t row = sizeof(float) * size.x;
    const auto address = reinterpret_cast<std::uintptr_t>(values) -
                         static_cast<std::uintptr_t>(origin.x * std::ptrdiff_t(sizeof(float))) -
                         static_cast<std::uintptr_t>(origin.y * static_cast<std::ptrdiff_t>(row));
    return {Imf::FLOAT, reinterpret_cast<char*>(address), sizeof(float), row};
}

Imf::Header makeHeader(const Image& image) {
    Imf::Header header(static_cast<int>(image.size.x), static_cast<int>(image.size.y));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 1; // noise hardly shrinks more at level 4, but takes a quarter longer
    Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec.709
    for (const auto& [name, text] : image.attributes)
        header.insert(std::string(PREFIX) + name, Imf::StringAttribute(text));
    for (const Channel& channel : image.channels) header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    return header;
}

std::vector<char> encode(const std::string& name, const Image& image) {
    Imf::FrameBuffer buffer;
    for (const Channel& channel : image.channels) {
        if (channel.values.size() != size_t(image.size.x) * image.size.y)
            throw std::invalid_argument(fmt::format("channel {} has {} values", channel.name, channel.values.size()));
        buffer.insert(channel.name, slice(channel.values.data(), image.size, {0, 0}));
    }
    MemoryStream stream(name);
    { // The file is complete when its object ends.
        Imf::OutputFile file(stream, makeHeader(image));
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(image.size.y));
    }
    return std::move(stream.content);
}

/// ZIP takes a whole core for seconds otherwise; what is written does not depend on the threads.
void startThreads() {
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
}

/// The size of a data window, refused if it is too large to be an image and not a damaged header.
uvec2 sizeOf(const Imath::Box2i& window) {
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > MAX_PIXELS / height)
        throw InputError(fmt::format("found {}x{} pixels; allowed are 1 to {}", width, height, MAX_PIXELS));
    return {static_cast<uint>(width), static_cast<uint>(height)};
}

Image imageOf(const Imf::Header& header, bool values) {
    Image image{.size = sizeOf(header.dataWindow())};
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
            throw InputError(fmt::format("channel {} is subsampled; allowed is one value per pixel", i.name()));
        image.channels.push_back({i.name(), std::vector<float>(values ? size_t(image.size.x) * image.size.y : 0)});
    }
    for (auto i = header.begin(); i != header.end(); ++i) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
        const std::string name = i.name();
        if (text && name.starts_with(PREFIX)) image.attributes[name.substr(PREFIX.size())] = text->value();
    }
    return image;
}

Image decode(const std::string& name, bool values) {
    Imf::InputFile file(name.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Image image = imageOf(file.header(), values);
    if (!values) return image;
    Imf::FrameBuffer buffer;
    for (Channel& channel : image.channels)
        buffer.insert(channel.name, slice(channel.values.data(), image.size, window.min));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

/// Refuses what cannot be opened or does not begin like an EXR file, with more to say than OpenEXR has.
void requireExr(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) throw InputError(fmt::format("{}: is a folder, not an EXR file", path.string()));
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    char magic[4]{};
    file.read(magic, sizeof magic);
    if (std::string_view(magic, 4) != "\x76\x2f\x31\x01")
        throw InputError(fmt::format("{}: is not an EXR file: it does not begin with 76 2f 31 01", path.string()));
}

} // namespace

void writeExr(const fs::path& path, const Image& image) {
    startThreads();
    std::vector<char> bytes;
    try {
        bytes = encode(path.string(), image);
    } catch (const std::exception& error) {
        throw std::runtime_error(fmt::format("{}: cannot be encoded: {}", path.string(), error.what()));
    }
    replaceFile(path, bytes);
}

static Image read(const fs::path& path, bool values) {
    requireExr(path);
    startThreads();
    try {
        return decode(path.string(), values);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: cannot be read as an EXR image: {}", path.string(), error.what()));
    }
}

Image readExr(const fs::path& path) { return read(path, true); }

Image readExrHeader(const fs::path& path) { return read(path, false); }

} // namespace vkpm
