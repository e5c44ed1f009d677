/// The layers of an image, found by the names of its channels.
#include "measure/image_layers.h"
#include <algorithm>
#include <string_view>

namespace vkpm {
namespace {

using Values = std::map<std::string, std::span<const float>>; // by channel

/// What stands before a channel's last letter: "direct." of direct.R, nothing of R.
std::string prefixOf(const std::string& name) { return name.substr(0, name.rfind('.') + 1); }

/// Whether a channel's name begins with state or residue and a number, as in state0.direct.R.
bool isSumOverPasses(const std::string& name) {
    for (const std::string_view word : {"state", "residue"}) {
        if (!name.starts_with(word)) continue;
        const size_t end = name.find_first_not_of("0123456789", word.size());
        if (end != word.size() && end != name.npos && name[end] == '.') return true;
    }
    return false;
}

/// The channels of a prefix that letters name, or none if one of them is missing.
std::vector<std::span<const float>> triple(const Values& values, const std::string& prefix,
                                           const std::string& letters) {
    std::vector<std::span<const float>> channels;
    for (const char letter : letters)
        if (const auto found = values.find(prefix + letter); found != values.end()) channels.push_back(found->second);
    if (channels.size() < letters.size()) channels.clear();
    return channels;
}

/// The layer that a channel is part of. X, Y and Z beside R, G and B of the same name stand alone.
Layer layerOf(const Values& values, const std::string& name, uvec2 size) {
    const std::string prefix = prefixOf(name);
    const bool isColour = !triple(values, prefix, "RGB").empty();
    const std::string letters = isColour ? "RGB" : "XYZ";
    auto channels = triple(values, prefix, letters);
    const bool isPart = name.size() == prefix.size() + 1 && letters.find(name.back()) != letters.npos;
    if (channels.empty() || !isPart) return {name, size, false, {values.at(name)}, {name}};
    const std::string unnamed = isColour ? "beauty" : "XYZ";
    std::vector<std::string> names;
    for (const char letter : letters) names.push_back(prefix + letter);
    return {prefix.empty() ? unnamed : prefix.substr(0, prefix.size() - 1), size, isColour, std::move(channels),
            std::move(names)};
}

} // namespace

std::vector<Layer> imageLayers(const Image& image) {
    Values values;
    for (const Channel& channel : image.channels) values[channel.name] = channel.values;
    std::vector<Layer> layers;
    for (const Channel& channel : image.channels) {
        if (isSumOverPasses(channel.name)) continue;
        Layer layer = layerOf(values, channel.name, image.size);
        const auto same = [&](const Layer& other) { return areComparable(layer, other); };
        if (std::ranges::none_of(layers, same)) layers.push_back(std::move(layer));
    }
    return layers;
}

bool areComparable(const Layer& a, const Layer& b) {
    return a.name == b.name && a.isColour == b.isColour && a.channels.size() == b.channels.size();
}

const Layer* comparableIn(const std::vector<Layer>& layers, const Layer& wanted) {
    const auto found = std::ranges::find_if(layers, [&](const Layer& layer) { return areComparable(layer, wanted); });
    return found == layers.end() ? nullptr : &*found;
}

} // namespace vkpm
