/// Writing of OpenEXR files, some rows at a time: OpenEXR writes the file, libdeflate compresses.
#include "output/atomic_file.h"
#include "output/exr.h"
#include <Imath/half.h>
#include <OpenEXR/openexr.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <libdeflate.h>
#include <numeric>
#include <tbb/parallel_pipeline.h>

namespace vkpm {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

const uint CHUNK = 16; // rows that ZIP compresses together
const uint BLOCK = 32; // rows that are made at a time
const int LEVEL = 1;   // noise hardly shrinks more at higher ones

std::size_t bytesOf(Storage storage) { return storage == Storage::half ? 2 : 4; }

/// The order of OpenEXR: by name.
std::vector<std::size_t> sortedByName(const Image& image) {
    std::vector<std::size_t> order(image.channels.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t i) { return image.channels[i].name; });
    return order;
}

/// The nearest half; what is finite stays finite, and counts if that changes it.
std::uint16_t halfOf(float value, std::uint64_t& clamped) {
    const Imath::half h(value);
    if (!h.isInfinity() || std::isinf(value)) return h.bits();
    clamped++;
    return Imath::half(value < 0 ? -65504.0f : 65504.0f).bits();
}

/// Rows of a chunk as OpenEXR lays them out: row by row, of each row channel by channel, little endian.
Bytes packed(const Image& block, const std::vector<std::size_t>& order, uint row, uint rows, std::uint64_t& clamped) {
    const std::size_t width = block.size.x;
    Bytes bytes;
    std::size_t perPixel = 0;
    for (const Channel& channel : block.channels) perPixel += bytesOf(channel.storage);
    bytes.resize(perPixel * width * rows);
    unsigned char* to = bytes.data();
    for (uint y = row; y < row + rows; y++)
        for (const std::size_t i : order) {
            const Channel& channel = block.channels[i];
            const float* from = channel.values.data() + y * width;
            if (channel.storage == Storage::half) {
                for (std::size_t x = 0; x < width; x++) {
                    const std::uint16_t bits = halfOf(from[x], clamped);
                    std::memcpy(to + 2 * x, &bits, 2);
                }
            } else {
                std::memcpy(to, from, 4 * width);
            }
            to += bytesOf(channel.storage) * width;
        }
    static_assert(std::endian::native == std::endian::little);
    return bytes;
}

/// OpenEXR's ZIP: every other byte in either half, differences of neighbours, deflate. What does not shrink stays as it
/// is.
Bytes compressed(Bytes raw) {
    thread_local const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(LEVEL), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    const std::size_t half = (raw.size() + 1) / 2, rest = raw.size() - half;
    Bytes apart(raw.size());
    const auto difference = [](unsigned char now, unsigned char before) {
        return static_cast<unsigned char>(now - before + 128);
    };
    apart[0] = raw[0];
    for (std::size_t i = 1; i < half; i++) apart[i] = difference(raw[2 * i], raw[2 * i - 2]);
    if (rest > 0) apart[half] = difference(raw[1], raw[2 * half - 2]);
    for (std::size_t i = 1; i < rest; i++) apart[half + i] = difference(raw[2 * i + 1], raw[2 * i - 1]);
    Bytes small(raw.size());
    const std::size_t bytes =
        libdeflate_zlib_compress(compressor.get(), apart.data(), apart.size(), small.data(), small.size());
    if (bytes == 0 || bytes >= raw.size()) return raw;
    small.resize(bytes);
    return small;
}

/// The file under construction.
class Writer {
public:
    Writer(const fs::path& path, uvec2 size, const std::map<std::string, std::string>& attributes, const Image& layout)
        : name(path.string()), file(path) {
        exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
        init.user_data = this;
        init.write_fn = write;
        init.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
        check(exr_start_write(&context, name.c_str(), EXR_WRITE_FILE_DIRECTLY, &init), "exr_start_write");
        check(exr_set_longname_support(context, 1), "exr_set_longname_support");
        int part = 0;
        check(exr_add_part(context, nullptr, EXR_STORAGE_SCANLINE, &part), "exr_add_part");
        check(exr_initialize_required_attr_simple(context, 0, int(size.x), int(size.y), EXR_COMPRESSION_ZIP),
              "exr_initialize_required_attr_simple");
        const exr_attr_chromaticities_t rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
        check(exr_attr_set_chromaticities(context, 0, "chromaticities", &rec709), "exr_attr_set_chromaticities");
        for (const auto& [key, text] : attributes)
            check(exr_attr_set_string(context, 0, (exrPrefix + key).c_str(), text.c_str()), "exr_attr_set_string");
        for (const std::size_t i : sortedByName(layout)) {
            const Channel& channel = layout.channels[i];
            const auto type = channel.storage == Storage::half   ? EXR_PIXEL_HALF
                              : channel.storage == Storage::bits ? EXR_PIXEL_UINT
                                                                 : EXR_PIXEL_FLOAT;
            check(exr_add_channel(context, 0, channel.name.c_str(), type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                  "exr_add_channel");
        }
        check(exr_write_header(context), "exr_write_header");
    }
    ~Writer() {
        if (context) exr_finish(&context);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void chunk(uint row, const Bytes& bytes) {
        check(exr_write_scanline_chunk(context, 0, int(row), bytes.data(), bytes.size()), "exr_write_scanline_chunk");
    }

    void commit() {
        check(exr_finish(&context), "exr_finish");
        context = nullptr;
        file.commit();
    }

private:
    static std::int64_t write(exr_const_context_t, void* self, const void* bytes, std::uint64_t size,
                              std::uint64_t offset, exr_stream_error_func_ptr_t) {
        auto* writer = static_cast<Writer*>(self);
        if (writer->failure) return -1;
        try {
            writer->file.write({static_cast<const char*>(bytes), size}, offset);
            return static_cast<std::int64_t>(size);
        } catch (...) {
            writer->failure = std::current_exception();
            return -1;
        }
    }

    void check(exr_result_t result, const char* call) {
        if (failure) std::rethrow_exception(failure);
        if (result != EXR_ERR_SUCCESS)
            throw std::runtime_error(
                fmt::format("{}: cannot be written: {}: {}", name, call, exr_get_default_error_message(result)));
    }

    std::string name;
    FileReplacement file;
    std::exception_ptr failure; // of the file
    exr_context_t context = nullptr;
};

/// Compressed chunks of some rows.
struct Packet {
    uint first = 0;
    std::vector<Bytes> chunks;
};

} // namespace

std::uint64_t writeExr(const fs::path& path, uvec2 size, const std::map<std::string, std::string>& attributes,
                       const ImageRows& rows) {
    const Image layout = rows(0, 0);
    const std::vector<std::size_t> order = sortedByName(layout);
    Writer writer(path, size, attributes, layout);
    std::atomic<std::uint64_t> clamped{0};
    uint next = 0;
    const auto take = [&](tbb::flow_control& control) {
        if (next >= size.y) control.stop();
        return std::exchange(next, std::min(next + BLOCK, size.y));
    };
    const auto compress = [&](uint first) {
        const uint count = std::min(BLOCK, size.y - first);
        Packet packet{first, {}};
        const Image block = rows(first, count);
        std::uint64_t large = 0;
        for (uint row = 0; row < count; row += CHUNK)
            packet.chunks.push_back(compressed(packed(block, order, row, std::min(CHUNK, count - row), large)));
        clamped += large;
        return packet;
    };
    const auto put = [&](const Packet& packet) {
        for (std::size_t i = 0; i < packet.chunks.size(); i++)
            writer.chunk(packet.first + uint(i) * CHUNK, packet.chunks[i]);
    };
    tbb::parallel_pipeline(4, tbb::make_filter<void, uint>(tbb::filter_mode::serial_in_order, take) &
                                  tbb::make_filter<uint, Packet>(tbb::filter_mode::parallel, compress) &
                                  tbb::make_filter<Packet, void>(tbb::filter_mode::serial_in_order, put));
    writer.commit();
    return clamped;
}

std::uint64_t writeExr(const fs::path& path, const Image& image) {
    for (const Channel& channel : image.channels)
        if (channel.values.size() != std::size_t(image.size.x) * image.size.y)
            throw std::invalid_argument(
                fmt::format("{}: channel {} has {} values", path.string(), channel.name, channel.values.size()));
    return writeExr(path, image.size, image.attributes, [&](uint first, uint count) {
        Image rows{.size = {image.size.x, count}};
        for (const Channel& channel : image.channels) {
            const auto begin = channel.values.begin() + std::ptrdiff_t(first) * image.size.x;
            rows.channels.push_back(
                {channel.name, {begin, begin + std::ptrdiff_t(count) * image.size.x}, channel.storage});
        }
        return rows;
    });
}

} // namespace vkpm
