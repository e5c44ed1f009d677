/// Sums of passes to channels and back.
#include "output/film_runs.h"
#include "gpu/error.h"
#include "settings.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>

namespace vkpm {
namespace {

/// The floats of a PixelSum, each with the layer that it belongs to, by place in layerNames.
struct Column {
    const char* name;
    uint layer;
};
constexpr std::array<Column, PIXEL_FLOATS> COLUMN_NAMES{{
    {"emission.R", 0}, {"emission.G", 0}, {"emission.B", 0}, {"direct.R", 1},         {"direct.G", 1},   {"direct.B", 1},
    {"specular.R", 2}, {"specular.G", 2}, {"specular.B", 2}, {"caustic.R", 3},        {"caustic.G", 3},  {"caustic.B", 3},
    {"indirect.R", 4}, {"indirect.G", 4}, {"indirect.B", 4}, {"albedo.R", 5},         {"albedo.G", 5},   {"albedo.B", 5},
    {"normal.X", 6},   {"normal.Y", 6},   {"normal.Z", 6},   {"depth.Z", ASK_DEPTH},  {"covered.Y", ASK_DEPTH},
    {"bias.R", 9},     {"bias.G", 9},     {"bias.B", 9},
    {"fine.R", 8},     {"fine.G", 8},     {"fine.B", 8},     {"coarse.R", ASK_NOISE}, {"coarse.G", 8},   {"coarse.B", 8},
    {"rest.R", 8},     {"rest.G", 8},     {"rest.B", 8},     {"square.Y", 9},
}};

std::string channelName(std::size_t run, std::size_t index) { return fmt::format("state{}.{}", run, COLUMN_NAMES[index].name); }

const Channel& channelOf(const Image& image, const std::string& name) {
    for (const Channel& channel : image.channels)
        if (channel.name == name) return channel;
    throw InputError(fmt::format("has no channel {}", name));
}

std::vector<std::size_t> columnsOf(uint layers) {
    std::vector<std::size_t> columns;
    for (std::size_t k = 0; k < PIXEL_FLOATS; k++)
        if (layers >> COLUMN_NAMES[k].layer & 1) columns.push_back(k);
    return columns;
}

/// Calls `copy` with a pixel and a column of `layers`; some pixels at a time, as many as stay in the cache.
template <class Copy> void forEachValue(std::size_t pixels, uint layers, Copy copy) {
    const std::vector<std::size_t> columns = columnsOf(layers);
    const std::size_t block = 256;
    for (std::size_t first = 0; first < pixels; first += block)
        for (const std::size_t k : columns)
            for (std::size_t i = first; i < std::min(first + block, pixels); i++) copy(i, k);
}

/// "12:16" at the front of `text`, which moves on behind it.
PassRange takeRange(std::string_view& text) {
    PassRange passes{};
    const auto take = [&](uint& value, char end) {
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const auto length = static_cast<std::size_t>(stop - text.data());
        if (error != std::errc() || (length < text.size() && text[length] != end)) return false;
        text.remove_prefix(std::min(length + 1, text.size()));
        return true;
    };
    if (!take(passes.begin, ':') || !take(passes.end, ' ') || passes.begin >= passes.end)
        throw InputError("its attribute vkpm/runs is damaged");
    return passes;
}

} // namespace

void addRun(Image& image, PassRange passes, std::span<const PixelSum> sums, uint layers) {
    std::string& runs = image.attributes["runs"];
    const auto index = runs.empty() ? 0 : std::ranges::count(runs, ' ') + 1;
    runs += fmt::format("{}{}:{}", runs.empty() ? "" : " ", passes.begin, passes.end);
    std::vector<Channel> channels; // of all columns
    for (std::size_t k = 0; k < PIXEL_FLOATS; k++) channels.push_back({channelName(std::size_t(index), k), {}});
    for (const std::size_t k : columnsOf(layers)) channels[k].values.resize(sums.size());
    forEachValue(sums.size(), layers, [&](std::size_t i, std::size_t k) { channels[k].values[i] = reinterpret_cast<const float*>(&sums[i])[k]; });
    for (const std::size_t k : columnsOf(layers)) image.channels.push_back(std::move(channels[k]));
}

std::vector<PassRange> runsOf(const Image& image) {
    const auto found = image.attributes.find("runs");
    if (found == image.attributes.end() || found->second.empty()) throw InputError("is not a render of vkpm: it has no attribute vkpm/runs");
    std::vector<PassRange> runs;
    for (std::string_view text = found->second; !text.empty();) {
        runs.push_back(takeRange(text));
        if (runs.size() > 1 && runs[runs.size() - 2].end != runs.back().begin) throw InputError("its attribute vkpm/runs is damaged");
    }
    return runs;
}

std::vector<PixelSum> sumsOf(const Image& image, std::size_t run, uint layers) {
    std::vector<PixelSum> sums(std::size_t(image.size.x) * image.size.y, PixelSum{});
    std::array<const float*, PIXEL_FLOATS> values{};
    for (const std::size_t k : columnsOf(layers)) values[k] = channelOf(image, channelName(run, k)).values.data();
    forEachValue(sums.size(), layers, [&](std::size_t i, std::size_t k) { reinterpret_cast<float*>(&sums[i])[k] = values[k][i]; });
    return sums;
}

std::string describe(PassRange passes) {
    return passes.end - passes.begin == 1 ? fmt::format("pass {}", passes.begin) : fmt::format("passes {} to {}", passes.begin, passes.end - 1);
}

} // namespace vkpm
