/// An image in memory: named channels of floats, and text that travels with it.
#pragma once
#include "shared.h"
#include <map>
#include <string>
#include <vector>

namespace vkpm {

struct Channel {
    std::string name{};          // R, direct.G, depth.Z ...
    std::vector<float> values{}; // row by row, the top row first
};

struct Image {
    uvec2 size{0};
    std::vector<Channel> channels{};
    std::map<std::string, std::string> attributes{}; // without the prefix vkpm/ that they have in a file
};

} // namespace vkpm
