/// Sums of passes to channels and back.
#include "output/film_runs.h"
#include "error.h"
#include "scene/settings.h"
#include "shared_film.h"
#include "shared_layers.h"
#include <algorithm>
#include <bit>
#include <charconv>
#include <fmt/format.h>

namespace vkpm {
namespace {

/// The floats of a PixelSum, each with the layer that it belongs to, by place in layerNames, and whether the file has
/// its mean, too.
struct Column {
    std::string name;
    uint layer;
    bool hasMean;
};

const std::vector<Column> COLUMN_NAMES = [] {
    std::vector<Column> columns;
    const auto add = [&](const char* name, std::string_view letters, uint layer, bool hasMean) {
        for (const char letter : letters) columns.push_back({fmt::format("{}.{}", name, letter), layer, hasMean});
    };
    for (uint layer = 0; layer < LAYER_COUNT; layer++) add(layerNames[layer], "RGB", layer, true);
    add("albedo", "RGB", ASK_ALBEDO, true);
    add("normal", "XYZ", ASK_NORMAL, true);
    add("depth", "Z", ASK_DEPTH, false); // the file has it over `covered`
    add("covered", "Y", ASK_DEPTH, false);
    add("bias", "RGB", ASK_BIAS, true);
    for (const char* name : {"fine", "coarse", "rest"}) add(name, "RGB", ASK_NOISE, false);
    add("square", "Y", ASK_BIAS, false);
    return columns;
}();

std::string stateName(std::size_t run, std::size_t column) {
    return fmt::format("state{}.{}", run, COLUMN_NAMES[column].name);
}
std::string residueName(std::size_t column) { return fmt::format("residue0.{}", COLUMN_NAMES[column].name); }

const Channel* channelOf(const Image& image, const std::string& name) {
    const auto found = std::ranges::find(image.channels, name, &Channel::name);
    return found == image.channels.end() ? nullptr : &*found;
}

std::vector<std::size_t> columnsOf(uint layers) {
    std::vector<std::size_t> columns;
    for (std::size_t k = 0; k < PIXEL_FLOATS; k++)
        if (layers >> COLUMN_NAMES[k].layer & 1) columns.push_back(k);
    return columns;
}

float& at(PixelSum& sum, std::size_t column) { return reinterpret_cast<float*>(&sum)[column]; }
float at(const PixelSum& sum, std::size_t column) { return reinterpret_cast<const float*>(&sum)[column]; }

/// What the mean over all passes and the sums of the later runs say of the first run's sum.
template <class Runs>
float predicted(float mean, uint passes, const Runs& runs, std::size_t pixel, std::size_t column) {
    double sum = double(mean) * passes; // each operation by itself, so that no compiler fuses two
    for (std::size_t run = 1; run < runs.size(); run++) sum -= double(at(runs[run][pixel], column));
    return float(sum);
}

/// How far apart two floats are in their order by bits, small for either sign.
uint residue(float value, float prediction) {
    const auto apart = static_cast<std::int32_t>(std::bit_cast<uint>(value) - std::bit_cast<uint>(prediction));
    return static_cast<uint>(apart) << 1 ^ static_cast<uint>(apart >> 31);
}

float fromResidue(uint bits, float prediction) {
    return std::bit_cast<float>(std::bit_cast<uint>(prediction) + (bits >> 1 ^ -(bits & 1)));
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

void addRuns(Image& rows, std::span<const Pixel> pixels, std::span<const std::span<const PixelSum>> sums, uint passes,
             uint layers, bool exactMeans) {
    const std::vector<std::size_t> columns = columnsOf(layers);
    const std::size_t block = 256; // pixels that stay in the cache
    for (std::size_t run = 0; run < sums.size(); run++) {
        const std::size_t firstChannel = rows.channels.size();
        const auto isResidue = [&](std::size_t k) { return run == 0 && exactMeans && COLUMN_NAMES[k].hasMean; };
        for (const std::size_t k : columns)
            rows.channels.push_back({isResidue(k) ? residueName(k) : stateName(run, k),
                                     std::vector<float>(pixels.size()),
                                     isResidue(k) ? Storage::bits : Storage::float32});
        for (std::size_t first = 0; first < pixels.size(); first += block)
            for (std::size_t c = 0; c < columns.size(); c++) {
                const std::size_t k = columns[c];
                std::vector<float>& values = rows.channels[firstChannel + c].values;
                for (std::size_t i = first; i < std::min(first + block, pixels.size()); i++) {
                    const float sum = at(sums[run][i], k);
                    values[i] = isResidue(k) ? std::bit_cast<float>(residue(
                                                   sum, predicted(reinterpret_cast<const float*>(&pixels[i].mean)[k],
                                                                  passes, sums, i, k)))
                                             : sum;
                }
            }
    }
}

std::string runsText(std::span<const PassRange> runs) {
    std::string text;
    for (const PassRange& run : runs) text += fmt::format("{}{}:{}", text.empty() ? "" : " ", run.begin, run.end);
    return text;
}

std::vector<PassRange> runsOf(const Image& image) {
    const auto found = image.attributes.find("runs");
    if (found == image.attributes.end() || found->second.empty()) {
        const bool isPicture = image.attributes.contains("passes") && image.attributes.contains("settings");
        throw InputError(isPicture ? "was saved with --no-resume: it has a picture, but not the sums over its passes, "
                                     "from which a render goes on or is merged"
                                   : "is not a render of vkpm: it has no attribute vkpm/runs");
    }
    std::vector<PassRange> runs;
    for (std::string_view text = found->second; !text.empty();) {
        runs.push_back(takeRange(text));
        if (runs.size() > 1 && runs[runs.size() - 2].end != runs.back().begin)
            throw InputError("its attribute vkpm/runs is damaged");
    }
    return runs;
}

std::vector<std::string> channelsOfSums(const Image& header, std::size_t runs, uint layers) {
    std::vector<std::string> names;
    for (std::size_t run = 0; run < runs; run++)
        for (const std::size_t k : columnsOf(layers)) {
            const bool asResidue =
                run == 0 && channelOf(header, residueName(k)) && channelOf(header, COLUMN_NAMES[k].name);
            if (asResidue) names.insert(names.end(), {residueName(k), COLUMN_NAMES[k].name});
            else if (channelOf(header, stateName(run, k))) names.push_back(stateName(run, k));
            else throw InputError(fmt::format("has no channel {}", stateName(run, k)));
        }
    return names;
}

std::vector<std::vector<PixelSum>> sumsOf(const Image& rows, std::size_t runs, uint passes, uint layers) {
    std::vector<std::vector<PixelSum>> sums(runs,
                                            std::vector<PixelSum>(std::size_t(rows.size.x) * rows.size.y, PixelSum{}));
    for (std::size_t run = runs; run-- > 0;) // the first one last, as it may depend on the others
        for (const std::size_t k : columnsOf(layers)) {
            if (const Channel* state = channelOf(rows, stateName(run, k))) {
                for (std::size_t i = 0; i < sums[run].size(); i++) at(sums[run][i], k) = state->values[i];
                continue;
            }
            const Channel &bits = *channelOf(rows, residueName(k)), &means = *channelOf(rows, COLUMN_NAMES[k].name);
            for (std::size_t i = 0; i < sums[run].size(); i++)
                at(sums[run][i], k) =
                    fromResidue(std::bit_cast<uint>(bits.values[i]), predicted(means.values[i], passes, sums, i, k));
        }
    return sums;
}

std::string describe(PassRange passes) {
    return passes.end - passes.begin == 1 ? fmt::format("pass {}", passes.begin)
                                          : fmt::format("passes {} to {}", passes.begin, passes.end - 1);
}

} // namespace vkpm
