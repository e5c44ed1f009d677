/// What the texts behind options mean. Each function throws NotAllowed at a text that it does not take.
#pragma once
#include "shared_film.h"
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vkpm {

namespace fs = std::filesystem;

constexpr uint MAX_COUNT = 0x7fffffff;

struct NotAllowed {
    std::string allowed; // in place of what was found
};

std::function<uint(const std::string&)> countsFrom(uint low, uint high);                // such as 200000 or 2e5
std::function<uint(const std::string&)> wordsOf(const std::vector<std::string>& words); // by place among them
float radiusOf(const std::string& text);
float alphaOf(const std::string& text);
double secondsOf(const std::string& text);
double errorOf(const std::string& text);
uint layersOf(const std::string& text); // bits of a list such as "direct,caustic", or of all
PassRange passRangeOf(const std::string& text);
uvec2 sizeOf(const std::string& text);
fs::path outputOf(const std::string& text); // to be written: its folder exists, and it is none itself
fs::path exrOf(const std::string& text);    // likewise
fs::path sceneOf(const std::string& text);

/// "; did you mean X?" for the known word that is nearest or goes on where this one ends; nothing if none is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

} // namespace vkpm
