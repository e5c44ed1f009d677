/// What the command line is read with: values of options, refused with what is allowed, and one command's parser.
#pragma once
#include "scene/scene.h"
#include "shared_film.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vkpm {

namespace fs = std::filesystem;

constexpr uint MAX_COUNT = 0x7fffffff;
constexpr uint MAX_SIDE = 65536;
constexpr uint MAX_PIXELS = 1u << 28;

[[noreturn]] inline void refuse(const std::string& option, const std::string& found, const std::string& allowed) {
    throw InputError(fmt::format("{}: found \"{}\"; allowed: {}", option, found, allowed));
}

/// The fewest insertions, deletions and replacements between two words (Levenshtein 1966).
inline size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i + 1);
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

/// "; did you mean X?" for the known word that is nearest or goes on where this one ends; nothing if none is near.
inline std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
    const size_t letters = word.size() - std::min(word.find_first_not_of('-'), word.size());
    const auto distance = [&](const std::string& other) {
        return letters > 1 && other.starts_with(word) ? 0 : editDistance(word, other);
    };
    const auto farther = [&](const auto& a, const auto& b) { return distance(a) < distance(b); };
    const auto nearest = std::min_element(known.begin(), known.end(), farther);
    const bool near = nearest != known.end() && 2 * distance(*nearest) < letters;
    return near ? fmt::format("; did you mean {}?", *nearest) : "";
}

/// A finite number that takes up the whole text and does not begin with a sign; else nothing.
template <class Number> std::optional<Number> numberOf(const std::string& text) {
    Number value{};
    const char* end = text.data() + text.size();
    if (text.empty() || (text[0] != '.' && (text[0] < '0' || text[0] > '9'))) return std::nullopt;
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

inline uint countOf(const std::string& option, const std::string& text, uint low, uint high) {
    const auto value = numberOf<double>(text);
    if (!value || *value < low || *value > high || *value != std::floor(*value))
        refuse(option, text, fmt::format("a whole number from {} to {}, such as 20000 or 2e4", low, high));
    return static_cast<uint>(*value);
}

inline float radiusOf(const std::string& option, const std::string& text) {
    const auto value = numberOf<float>(text);
    if (!value || *value <= 0) refuse(option, text, "a number above 0, in world units, such as 0.05");
    return *value;
}

inline double secondsOf(const std::string& option, const std::string& text) {
    const auto value = numberOf<double>(text);
    if (!value || *value <= 0) refuse(option, text, "a number of seconds above 0, such as 60");
    return *value;
}

inline double errorOf(const std::string& option, const std::string& text) {
    const bool percent = text.ends_with('%');
    const auto value = numberOf<double>(text.substr(0, text.size() - percent));
    if (!value || *value <= 0) refuse(option, text, "a relative error above 0, such as 0.01 or 1%");
    return percent ? *value / 100 : *value;
}

inline float alphaOf(const std::string& option, const std::string& text) {
    const auto value = numberOf<float>(text);
    if (!value || *value <= 0 || *value > 1) refuse(option, text, "a number above 0, at most 1, such as 0.6667");
    return *value;
}

/// Bits of the layers in a list such as "direct,caustic", or of all.
inline uint layersOf(const std::string& option, const std::string& text) {
    if (text == "all") return allLayers;
    uint layers = 0;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const auto found = std::ranges::find(layerNames, text.substr(begin, end - begin));
        if (found == layerNames.end())
            refuse(option, text,
                   fmt::format("all, or names with commas between them, of {}", fmt::join(layerNames, ", ")));
        layers |= 1u << (found - layerNames.begin());
        begin = end + 1;
    }
    return layers;
}

inline PassRange passRangeOf(const std::string& option, const std::string& text) {
    const size_t colon = std::min(text.find(':'), text.size());
    const auto number = [](const std::string& digits) { return numberOf<double>(digits).value_or(-1); };
    const double begin = number(text.substr(0, colon));
    const double end = colon < text.size() ? number(text.substr(colon + 1)) : -1;
    const bool whole = begin == std::floor(begin) && end == std::floor(end);
    if (!whole || begin < 0 || end <= begin || end > MAX_COUNT)
        refuse(option, text,
               fmt::format("FIRST:END, whole numbers, FIRST below END, END at most {}, such as 0:16", MAX_COUNT));
    return {static_cast<uint>(begin), static_cast<uint>(end)};
}

inline uvec2 sizeOf(const std::string& option, const std::string& text) {
    const auto side = [](const std::string& digits) {
        const double value = numberOf<double>(digits).value_or(0);
        return value <= MAX_SIDE && value == std::floor(value) ? static_cast<uint>(value) : 0;
    };
    const size_t x = std::min(text.find_first_of("xX"), text.size());
    const uvec2 size{side(text.substr(0, x)), x < text.size() ? side(text.substr(x + 1)) : 0};
    if (size.x == 0 || size.y == 0 || std::uint64_t(size.x) * size.y > MAX_PIXELS)
        refuse(option, text,
               fmt::format("WIDTHxHEIGHT in pixels, such as 640x480, each from 1 to {}, their product at most {}",
                           MAX_SIDE, MAX_PIXELS));
    return size;
}

/// A file that is to be written: its folder exists, and it is none itself.
inline fs::path outputOf(const std::string& option, const std::string& text) {
    const fs::path path = text;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code error;
    if (!path.has_filename() || fs::is_directory(path, error)) refuse(option, text, "a file, this is a folder");
    if (!fs::is_directory(folder, error)) refuse(option, text, "a file in a folder that exists; create it first");
    return path;
}

inline fs::path exrOf(const std::string& option, const std::string& text) {
    if (fs::path(text).extension() != ".exr") refuse(option, text, "a file name that ends in .exr");
    return outputOf(option, text);
}

inline fs::path sceneOf(const std::string& option, const std::string& text) {
    std::error_code error;
    if (fs::is_directory(text, error)) refuse(option, text, "a scene file, this is a folder");
    if (!fs::exists(text, error)) refuse(option, text, "a scene file that exists");
    return text;
}

/// The words that an option takes, and what they stand for.
using Words = std::vector<std::pair<std::string, uint>>;

inline std::vector<std::string> namesOf(const Words& words) {
    std::vector<std::string> names;
    for (const auto& [name, value] : words) names.push_back(name);
    return names;
}

inline std::string wordOf(const Words& words, uint value) {
    for (const auto& [name, id] : words)
        if (id == value) return name;
    return "?";
}

inline uint valueOf(const std::string& option, const Words& words, const std::string& text) {
    for (const auto& [name, value] : words)
        if (name == text) return value;
    const std::vector<std::string> names = namesOf(words);
    refuse(option, text, fmt::format("{}{}", fmt::join(names, ", "), suggestion(text, names)));
}

/// CLI11's help with a usage line of ours.
class HelpFormatter : public CLI::Formatter {
public:
    explicit HelpFormatter(std::string line) : usage(std::move(line)) { column_width(33); }
    std::string make_usage(const CLI::App*, std::string) const override { return fmt::format("Usage: {}\n", usage); }

private:
    std::string usage;
};

const char* const versionText = "vkpm " VKPM_VERSION "\n";

/// One command's options: CLI11 splits the command line, what the values mean is looked at afterwards, so that
/// --help and unknown options come before wrong values.
class Parser {
public:
    using Take = std::function<void(const std::string& name, const std::string& value)>;

    Parser(const std::string& description, const std::string& usage) : app(description) {
        app.set_help_flag("-h,--help", "print this");
        app.set_version_flag("--version", VKPM_VERSION, "print version, commit and driver");
        app.allow_extras();
        app.formatter(std::make_shared<HelpFormatter>(usage));
    }

    void group(const std::string& title) { heading = title; }

    void add(const std::string& names, const std::string& type, const std::string& help, Take take) {
        const std::string name = names.substr(names.rfind("--"));
        const auto defer = [this, name, take](const std::string& value) {
            if (value.empty() || value.starts_with("--")) refuse(name, value, "a value");
            pending.push_back([=] { take(name, value); });
        };
        app.add_option_function<std::string>(names, defer, help)->type_name(type)->group(heading);
    }

    void words(const std::string& name, const Words& list, const std::string& help, std::function<void(uint)> take) {
        add(name, fmt::format("{}", fmt::join(namesOf(list), "|")), help,
            [&list, take](const std::string& option, const std::string& value) { take(valueOf(option, list, value)); });
    }

    void flag(const std::string& name, const std::string& help, bool& value) {
        app.add_flag(name, value, help)->group(heading)->disable_flag_override();
    }

    /// Arguments without a name.
    void files(const std::string& name, const std::string& help,
               std::function<void(const std::vector<std::string>&)> take) {
        app.add_option(name, fileNames, help)->type_name("FILE");
        positional = [=, this] { take(fileNames); };
    }

    /// Splits the arguments, refuses unknown ones, then takes the values; the text to print for --help, --version.
    std::string parse(std::span<const std::string> arguments) {
        try {
            app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        } catch (const CLI::CallForHelp&) {
            return help();
        } catch (const CLI::CallForVersion&) {
            return versionText;
        } catch (const CLI::ArgumentMismatch& error) {
            throw InputError(mismatch(error.what()));
        } catch (const CLI::ParseError& error) {
            throw InputError(fmt::format("{}; see vkpm --help", error.what()));
        }
        refuseUnknown();
        for (const auto& take : pending) take();
        if (positional) positional();
        return "";
    }

    /// The help, with single blank lines between its groups.
    std::string help() const {
        std::string text = app.help();
        for (size_t i; (i = text.find("\n\n\n")) != text.npos;) text.erase(i, 1);
        return text;
    }

    void footer(const std::string& text) { app.footer(text); }

private:
    /// CLI11's "--passes: 1 required N missing" and "quiet was given a disallowed flag override" in our words.
    static std::string mismatch(const std::string& text) {
        if (text.find("flag override") != text.npos)
            return fmt::format("--{}: found a value; allowed: none", text.substr(0, text.find(' ')));
        const char* found = text.find("missing") != text.npos ? "no value" : "more than one value";
        return fmt::format("{}: found {}; allowed: one value", text.substr(0, text.find(':')), found);
    }

    void refuseUnknown() const {
        std::vector<std::string> unknown = app.remaining();
        if (unknown.empty()) return;
        const auto isOption = [](const std::string& word) { return word.starts_with('-') && word != "--"; };
        std::stable_partition(unknown.begin(), unknown.end(), isOption);
        const std::string word = unknown[0].substr(0, unknown[0].find('='));
        if (!isOption(word)) throw InputError(fmt::format("found \"{}\", which belongs to no option", word));
        std::vector<std::string> known;
        for (const CLI::Option* option : app.get_options()) known.push_back(option->get_name());
        throw InputError(fmt::format("{}: unknown option{}; see vkpm --help", word, suggestion(word, known)));
    }

    CLI::App app;
    std::string heading = "Options";
    std::vector<std::function<void()>> pending;
    std::vector<std::string> fileNames;
    std::function<void()> positional;
};

} // namespace vkpm
