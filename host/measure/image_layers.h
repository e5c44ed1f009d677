/// The layers of an image: channels that belong together.
#pragma once
#include "output/image.h"
#include <span>

namespace vkpm {

/// A colour (channels R, G and B), a vector (X, Y and Z), or a channel that stands alone.
struct Layer {
    std::string name{}; // beauty, direct, normal; of a channel alone its full name: depth.Z
    uvec2 size{0};
    bool isColour = false;
    std::vector<std::span<const float>> channels{}; // the image's own values
    std::vector<std::string> channelNames{};
};

/// The layers of an image in the order of its channels, beauty being R, G and B without a name before them. Leaves out
/// sums over passes (state0. ...). The image has to outlive them.
std::vector<Layer> imageLayers(const Image& image);

/// Whether two layers hold the same thing: alike in name and channels.
bool areComparable(const Layer& a, const Layer& b);

/// The layer among others that is comparable to one; null if there is none.
const Layer* comparableIn(const std::vector<Layer>& layers, const Layer& wanted);

} // namespace vkpm
