/// An image in memory: named channels of floats, and text that travels with it.
#pragma once
#include "shared.h"
#include <map>
#include <string>
#include <vector>

namespace vkpm {

/// How a channel's values are kept in a file: as they are, as the nearest 16-bit floats, or as the bits of whole
/// numbers.
enum class Storage { float32, half, bits };

struct Channel {
    std::string name{};          // R, direct.G, depth.Z ...
    std::vector<float> values{}; // row by row, the top row first
    Storage storage = Storage::float32;
};

struct Image {
    uvec2 size{0};
    std::vector<Channel> channels{};
    std::map<std::string, std::string> attributes{}; // without the prefix vkpm/ that they have in a file
};

} // namespace vkpm
