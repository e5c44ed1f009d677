/// Reading of OpenEXR files: the flat parts of a file as one picture.
#include "error.h"
#include "output/channel_names.h"
#include "output/exr.h"
#include "scene/settings.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <string_view>
#include <thread>

namespace vkpm {
namespace {

namespace fs = std::filesystem;

void startThreads() {
    if (Imf::globalThreadCount() == 0) Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
}

/// The size of a window, refused if it is too large to be an image and not a damaged header.
uvec2 sizeOf(const Imath::Box2i& window) {
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > std::int64_t{maxPixels} / height)
        throw InputError(fmt::format("found {}x{} pixels; allowed are 1 to {}", width, height, maxPixels));
    return {static_cast<uint>(width), static_cast<uint>(height)};
}

PixelBox relative(const Imath::Box2i& window, Imath::V2i corner) {
    (void)sizeOf(window);
    return {{window.min.x - corner.x, window.min.y - corner.y}, {window.max.x - corner.x, window.max.y - corner.y}};
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

/// Calls `read`, and gives what it throws the name of the file.
template <class Read> auto attempt(const fs::path& path, Read read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: cannot be read as an EXR image: {}", path.string(), error.what()));
    }
}

} // namespace

std::string describe(const PixelBox& window) {
    return fmt::format("{},{} to {},{}", window.low.x, window.low.y, window.high.x, window.high.y);
}

struct ExrFile::Parts {
    explicit Parts(const fs::path& path) : file(path.c_str()) {}

    Imf::MultiPartInputFile file;
    Imath::V2i corner = file.header(0).displayWindow().min; // of the picture
};

ExrFile::ExrFile(const fs::path& file) : path(file) {
    requireExr(path);
    startThreads();
    attempt(path, [&] {
        parts = std::make_unique<Parts>(path);
        pictureSize = sizeOf(parts->file.header(0).displayWindow());
        std::vector<std::string> names;
        for (int part = 0; part < parts->file.parts(); part++) {
            const Imf::Header& header = parts->file.header(part);
            const std::string partName = header.hasName() ? header.name() : fmt::format("part {}", part);
            if (header.hasType() && Imf::isDeepData(header.type())) {
                skipped += fmt::format("{}{} (deep)", skipped.empty() ? "" : ", ", partName);
                continue;
            }
            const PixelBox window = relative(header.dataWindow(), parts->corner);
            for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
                const std::string channel = i.name();
                const bool alone = parts->file.parts() == 1 || channel.starts_with(partName + ".");
                const std::string name = alone ? channel : partName + "." + channel;
                if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
                    skipped += fmt::format("{}{} (subsampled)", skipped.empty() ? "" : ", ", name);
                    continue;
                }
                const bool bits = i.channel().type == Imf::UINT && channel.starts_with("residue");
                names.push_back(name);
                list.push_back({"", name, window, channel, part, bits ? Storage::bits : Storage::float32});
            }
            for (auto i = header.begin(); i != header.end(); ++i) {
                const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
                const std::string name = i.name();
                if (text && name.starts_with(exrPrefix)) texts[name.substr(exrPrefix.size())] = text->value();
            }
        }
        const std::vector<std::string> ours = ourNames(names);
        std::set<std::string> known;
        std::erase_if(list, [&, index = std::size_t(0)](Entry& entry) mutable {
            entry.name = ours[index++];
            return !known.insert(entry.name).second; // a later part with the same names
        });
        if (list.empty())
            throw InputError(fmt::format("it has no channel with a value per pixel{}{}",
                                         skipped.empty() ? "" : "; found: ", skipped));
    });
}

ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;
ExrFile& ExrFile::operator=(ExrFile&&) noexcept = default;

Image ExrFile::header() const {
    Image image{.size = pictureSize, .attributes = texts};
    for (const Entry& entry : list) image.channels.push_back({entry.name, {}, entry.storage});
    return image;
}

Image ExrFile::read(std::span<const std::string> names, const PixelBox& region) const {
    const uvec2 size(region.high - region.low + 1);
    Image image{.size = size, .attributes = texts};
    for (const std::string& name : names)
        image.channels.push_back({name, std::vector<float>(std::size_t(size.x) * size.y)});
    return attempt(path, [&] {
        for (int part = 0; part < parts->file.parts(); part++) {
            const Imath::Box2i data = parts->file.header(part).dataWindow();
            const std::size_t width = std::size_t(std::int64_t(data.max.x) - data.min.x + 1);
            const bool cut =
                region.low.x + parts->corner.x != data.min.x || region.high.x + parts->corner.x != data.max.x;
            const int firstRow = region.low.y + parts->corner.y;
            // A part whose rows are wider is read some rows at a time into rows of its own width.
            const std::size_t step = cut ? std::min<std::size_t>(size.y, 64) : size.y;
            std::vector<std::vector<float>> wide;
            for (std::size_t row = 0; row < size.y; row += step) {
                const std::size_t rows = std::min(step, size.y - row);
                Imf::FrameBuffer buffer;
                std::vector<std::pair<Channel*, std::size_t>> copies;
                wide.clear();
                for (Channel& channel : image.channels) {
                    const auto entry = std::ranges::find(list, channel.name, &Entry::name);
                    if (entry == list.end()) throw InputError(fmt::format("has no channel {}", channel.name));
                    if (entry->part != part) continue;
                    channel.storage = entry->storage;
                    float* first = channel.values.data() + row * size.x;
                    if (cut) {
                        copies.emplace_back(&channel, wide.size());
                        first = wide.emplace_back(rows * width).data();
                    }
                    const auto address = reinterpret_cast<std::uintptr_t>(first) -
                                         sizeof(float) * std::uintptr_t(std::intptr_t(data.min.x)) -
                                         sizeof(float) * width * std::uintptr_t(std::intptr_t(firstRow + int(row)));
                    buffer.insert(entry->channel,
                                  Imf::Slice(entry->storage == Storage::bits ? Imf::UINT : Imf::FLOAT,
                                             reinterpret_cast<char*>(address), sizeof(float), sizeof(float) * width));
                }
                if (buffer.begin() == buffer.end()) continue;
                Imf::InputPart input(parts->file, part);
                input.setFrameBuffer(buffer);
                input.readPixels(firstRow + int(row), firstRow + int(row + rows) - 1);
                const std::size_t skip = std::size_t(region.low.x + parts->corner.x - data.min.x);
                for (const auto& [channel, index] : copies)
                    for (std::size_t y = 0; y < rows; y++)
                        std::copy_n(wide[index].data() + y * width + skip, size.x,
                                    channel->values.data() + (row + y) * size.x);
            }
        }
        return std::move(image);
    });
}

void ExrFile::requireWhole() const {
    const PixelBox whole{glm::ivec2(0), glm::ivec2(pictureSize) - 1};
    for (const Entry& entry : list)
        if (glm::any(glm::greaterThan(entry.window.low, whole.low)) ||
            glm::any(glm::lessThan(entry.window.high, whole.high)))
            throw InputError(fmt::format("{}: channel {} has values at {} alone (data window) of a picture of {}x{} "
                                         "pixels (display window); allowed: a file that has the whole picture",
                                         path.string(), entry.inFile, describe(entry.window), pictureSize.x,
                                         pictureSize.y));
}

Image readExr(const fs::path& path) {
    const ExrFile file(path);
    file.requireWhole();
    std::vector<std::string> names;
    for (const ExrFile::Entry& entry : file.entries()) names.push_back(entry.name);
    return file.read(names, {glm::ivec2(0), glm::ivec2(file.size()) - 1});
}

Image readExrHeader(const fs::path& path) { return ExrFile(path).header(); }

} // namespace vkpm
