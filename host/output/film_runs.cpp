/// Sums of passes to channels and back.
#include "output/film_runs.h"
#include "gpu/error.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>

namespace vkpm {
namespace {

static_assert(sizeof(PixelSum) == PIXEL_FLOATS * sizeof(float));
constexpr std::array<const char*, PIXEL_FLOATS> NAMES{
    "emission.R", "emission.G", "emission.B", "direct.R",   "direct.G",   "direct.B", "specular.R",  "specular.G",  "specular.B",
    "caustic.R",  "caustic.G",  "caustic.B",  "indirect.R", "indirect.G", "indirect.B", "albedo.R",  "albedo.G",    "albedo.B",
    "normal.X",   "normal.Y",   "normal.Z",   "depth.Z",    "covered.Y",  "deviation.R", "deviation.G", "deviation.B"};

std::string channelName(std::size_t run, std::size_t index) { return fmt::format("state{}.{}", run, NAMES[index]); }

const Channel& channelOf(const Image& image, const std::string& name) {
    for (const Channel& channel : image.channels)
        if (channel.name == name) return channel;
    throw InputError(fmt::format("has no channel {}", name));
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

void addRun(Image& image, PassRange passes, std::span<const PixelSum> sums) {
    std::string& runs = image.attributes["runs"];
    const auto index = runs.empty() ? 0 : std::ranges::count(runs, ' ') + 1;
    runs += fmt::format("{}{}:{}", runs.empty() ? "" : " ", passes.begin, passes.end);
    for (std::size_t k = 0; k < PIXEL_FLOATS; k++) {
        std::vector<float> values;
        values.reserve(sums.size());
        for (const PixelSum& sum : sums) values.push_back(reinterpret_cast<const float*>(&sum)[k]);
        image.channels.push_back({channelName(std::size_t(index), k), std::move(values)});
    }
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

std::vector<PixelSum> sumsOf(const Image& image, std::size_t run) {
    std::vector<PixelSum> sums(std::size_t(image.size.x) * image.size.y);
    for (std::size_t k = 0; k < PIXEL_FLOATS; k++) {
        const std::vector<float>& values = channelOf(image, channelName(run, k)).values;
        for (std::size_t i = 0; i < sums.size(); i++) reinterpret_cast<float*>(&sums[i])[k] = values[i];
    }
    return sums;
}

std::string describe(PassRange passes) {
    return passes.end - passes.begin == 1 ? fmt::format("pass {}", passes.begin) : fmt::format("passes {} to {}", passes.begin, passes.end - 1);
}

} // namespace vkpm
