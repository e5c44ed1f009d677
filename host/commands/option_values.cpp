/// What the texts behind options mean.
#include "commands/option_values.h"
#include "scene/settings.h"
#include "scene/text.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace vkpm {

/// The positive number that takes up a whole text; 0 for zero, NaN if there is none, or one beyond the range of float.
static double numberOf(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    if (text.empty() || (text[0] != '.' && (text[0] < '0' || text[0] > '9'))) return NAN;
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && std::isfinite(float(value)) ? value : NAN;
}

static double positiveOf(const std::string& text, const char* allowed, double high = INFINITY) {
    const double value = numberOf(text);
    if (!(float(value) > 0 && value <= high)) throw NotAllowed{allowed};
    return value;
}

/// A whole number within bounds; nothing if the text is none.
static std::optional<uint> wholeOf(const std::string& text, uint low, uint high) {
    const double value = numberOf(text);
    if (!(value >= low && value <= high && value == std::floor(value))) return std::nullopt;
    return static_cast<uint>(value);
}

/// The pieces of a text between separators.
static std::vector<std::string> split(const std::string& text, const char* separators) {
    std::vector<std::string> pieces;
    for (std::size_t begin = 0, end; begin <= text.size(); begin = end + 1) {
        end = std::min(text.find_first_of(separators, begin), text.size());
        pieces.push_back(text.substr(begin, end - begin));
    }
    return pieces;
}

std::function<uint(const std::string&)> countsFrom(uint low, uint high) {
    return [=](const std::string& text) {
        if (const auto value = wholeOf(text, low, high)) return *value;
        throw NotAllowed{fmt::format("a whole number from {} to {}, such as 20000 or 2e4", low, high)};
    };
}

std::function<uint(const std::string&)> wordsOf(const std::vector<std::string>& words) {
    return [=](const std::string& text) {
        const auto found = std::ranges::find(words, text);
        if (found != words.end()) return static_cast<uint>(found - words.begin());
        throw NotAllowed{fmt::format("{}{}", fmt::join(words, ", "), suggestion(text, words))};
    };
}

float radiusOf(const std::string& text) {
    return float(positiveOf(text, "a number above 0, in world units, such as 0.05"));
}

float alphaOf(const std::string& text) {
    return float(positiveOf(text, "a number above 0, at most 1, such as 0.6667", 1));
}

double secondsOf(const std::string& text) { return positiveOf(text, "a number of seconds above 0, such as 60"); }

double errorOf(const std::string& text) {
    const bool percent = text.ends_with('%');
    const std::string number = text.substr(0, text.size() - percent);
    return positiveOf(number, "a relative error above 0, such as 0.01 or 1%") / (percent ? 100 : 1);
}

uint layersOf(const std::string& text) {
    if (text == "all") return allLayers;
    uint layers = 0;
    for (const std::string& name : split(text, ",")) {
        const auto found = std::ranges::find(layerNames, name);
        if (found == layerNames.end())
            throw NotAllowed{fmt::format("all, or names with commas between them, of {}", fmt::join(layerNames, ", "))};
        layers |= 1u << (found - layerNames.begin());
    }
    return layers;
}

PassRange passRangeOf(const std::string& text) {
    const std::vector<std::string> ends = split(text, ":");
    const auto begin = wholeOf(ends.front(), 0, MAX_COUNT), end = wholeOf(ends.back(), 1, MAX_COUNT);
    if (ends.size() == 2 && begin && end && *begin < *end) return {*begin, *end};
    throw NotAllowed{fmt::format("FIRST:END, whole numbers, FIRST below END, END at most {}, such as 0:16", MAX_COUNT)};
}

uvec2 sizeOf(const std::string& text) {
    const std::vector<std::string> sides = split(text, "xX");
    const auto x = wholeOf(sides.front(), 1, maxSide), y = wholeOf(sides.back(), 1, maxSide);
    if (sides.size() == 2 && x && y && std::uint64_t(*x) * *y <= maxPixels) return {*x, *y};
    throw NotAllowed{fmt::format("WIDTHxHEIGHT in pixels, such as 640x480, each from 1 to {}, their product at most {}",
                                 maxSide, maxPixels)};
}

fs::path outputOf(const std::string& text) {
    const fs::path path = text;
    std::error_code error;
    if (!path.has_filename() || fs::is_directory(path, error)) throw NotAllowed{"a file, this is a folder"};
    if (path.has_parent_path() && !fs::is_directory(path.parent_path(), error))
        throw NotAllowed{"a file in a folder that exists; create it first"};
    return path;
}

fs::path exrOf(const std::string& text) {
    if (fs::path(text).extension() != ".exr") throw NotAllowed{"a file name that ends in .exr"};
    return outputOf(text);
}

fs::path sceneOf(const std::string& text) {
    std::error_code error;
    if (fs::is_directory(text, error)) throw NotAllowed{"a scene file, this is a folder"};
    if (!fs::exists(text, error)) throw NotAllowed{"a scene file that exists"};
    return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
    const auto goesOn = [&](const std::string& other) { return word.size() > 3 && other.starts_with(word); };
    const auto longer = std::ranges::find_if(known, goesOn);
    const std::string nearest = longer != known.end() ? *longer : nearestWord(word, known);
    return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

} // namespace vkpm
