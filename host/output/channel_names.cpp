/// Which channels are beauty.
#include "output/channel_names.h"
#include "scene/settings.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

namespace vkpm {
namespace {

std::string lower(std::string_view text) {
    std::string result;
    for (const char c : text) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

/// "direct." of direct.R, nothing of R.
std::string layerPrefix(const std::string& name) { return name.substr(0, name.rfind('.') + 1); }

/// Of "ViewLayer.Combined." the last word, in small letters.
std::string wordOf(std::string_view prefix) {
    prefix.remove_suffix(prefix.empty() ? 0 : 1);
    return lower(prefix.substr(prefix.rfind('.') + 1));
}

/// Letters R, G, B and A for whatever stands for them.
std::string withLetters(const std::string& name) {
    const std::string prefix = layerPrefix(name), last = name.substr(prefix.size());
    for (const auto& [word, letter] : {std::pair("r", "R"),
                                       {"g", "G"},
                                       {"b", "B"},
                                       {"a", "A"},
                                       {"red", "R"},
                                       {"green", "G"},
                                       {"blue", "B"},
                                       {"alpha", "A"}})
        if (lower(last) == word) return prefix + letter;
    return name;
}

/// Prefixes that have R, G and B.
std::vector<std::string> coloursOf(const std::vector<std::string>& names) {
    const std::set<std::string> all(names.begin(), names.end());
    std::vector<std::string> colours;
    for (const std::string& name : names)
        if (const std::string prefix = layerPrefix(name);
            name == prefix + "R" && all.contains(prefix + "G") && all.contains(prefix + "B"))
            colours.push_back(prefix);
    return colours;
}

/// The prefix of beauty; nothing if no colour is known to be that.
std::string beautyAmong(const std::vector<std::string>& colours) {
    for (const char* word : {"combined", "beauty", "rgba", "rgb", "rgb_color", "rgb color", "color", "colour", "image",
                             "<root>", "root", "final", "composite", "c", "ci", "effectsresult", "main"})
        for (const std::string& prefix : colours)
            if (wordOf(prefix) == word) return prefix;
    if (colours.size() != 1 || std::ranges::find(layerNames, wordOf(colours[0])) != layerNames.end()) return "";
    return colours[0];
}

} // namespace

std::vector<std::string> ourNames(const std::vector<std::string>& names) {
    std::vector<std::string> ours;
    for (const std::string& name : names) ours.push_back(withLetters(name));
    if (std::set<std::string>(ours.begin(), ours.end()).size() < ours.size()) return names; // two would become one
    const std::vector<std::string> colours = coloursOf(ours);
    if (std::ranges::find(colours, "") != colours.end()) return ours;
    const std::string beauty = beautyAmong(colours);
    if (beauty.empty()) return ours;
    const std::string layer =
        wordOf(beauty) == "combined" ? beauty.substr(0, beauty.size() - std::string_view("Combined.").size()) : "";
    for (std::string& name : ours) {
        if (name.starts_with(beauty)) name.erase(0, beauty.size());
        else if (!layer.empty() && name.starts_with(layer)) name.erase(0, layer.size());
    }
    return ours;
}

} // namespace vkpm
