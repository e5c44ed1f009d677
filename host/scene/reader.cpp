/// A typed reader of JSON: types, ranges and unknown keys, each with its place.
#include "scene/reader.h"
#include "scene/text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
using nlohmann::json;

namespace {

std::string describeRange(Range range) {
    constexpr float largest = std::numeric_limits<float>::max();
    if (range.high == largest && range.low == -largest) return "a finite number (32-bit float)";
    if (range.high == largest) return fmt::format("a finite number {} {}", range.aboveLow ? ">" : ">=", range.low);
    return fmt::format("a number {} {} and <= {}", range.aboveLow ? ">" : ">=", range.low, range.high);
}

bool contains(Range range, float x) { return x >= range.low && x <= range.high && !(range.aboveLow && x == range.low); }

/// A key as a step of a JSON pointer (RFC 6901).
std::string pointerStep(std::string_view key) {
    std::string step = "/";
    for (const char c : key) step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return step;
}

} // namespace

void Reader::fail(std::string_view found, std::string_view allowed) const {
    refuseFile(*file, ": " + (pointer.empty() ? "/" : pointer), found, allowed);
}

void Reader::warn(std::vector<std::string>& warnings, std::string_view message) const {
    warnings.push_back(
        fmt::format("{}: {}: {}", printable(file->string()), pointer.empty() ? "/" : printable(pointer), message));
}

std::string Reader::describe() const {
    if (value->is_object()) return "found an object";
    if (value->is_array()) return fmt::format("found an array of {}", value->size());
    return "found " + printable(value->dump(-1, ' ', false, json::error_handler_t::replace), 60);
}

Reader Reader::child(std::string_view key, const json& member) const {
    Reader reader{*file, member};
    reader.pointer = pointer + pointerStep(key);
    return reader;
}

const json& Reader::object() const {
    if (!value->is_object()) fail(describe(), "allowed is an object, {...}");
    return *value;
}

Reader Reader::at(std::string_view key) {
    if (std::optional<Reader> member = find(key)) return std::move(*member);
    for (const std::string& other : keys())
        if (nearestWord(other, {std::string{key}}) == key && std::ranges::find(known, other) == known.end())
            failUnknown(other);
    fail(fmt::format("the key \"{}\" is missing", key), "it is required here");
}

std::optional<Reader> Reader::find(std::string_view key) {
    known.emplace_back(key);
    const auto member = object().find(std::string{key});
    if (member == value->end()) return std::nullopt;
    return child(key, *member);
}

std::vector<std::string> Reader::keys() const {
    std::vector<std::string> names;
    for (const auto& [name, member] : object().items()) names.push_back(name);
    return names;
}

void Reader::finish() const {
    for (const std::string& key : keys())
        if (std::ranges::find(known, key) == known.end()) failUnknown(key);
}

void Reader::failUnknown(std::string_view key) const {
    const std::string nearest = nearestWord(key, known);
    const std::string hint = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
    child(key, *value)
        .fail(fmt::format("unknown key \"{}\"", printable(key, 60)),
              fmt::format("{}known here: {}", hint, quotedList(known)));
}

std::size_t Reader::count(std::size_t low, std::size_t high, std::string_view allowed) const {
    if (!value->is_array() || value->size() < low || value->size() > high)
        fail(describe(), fmt::format("allowed is {}", allowed));
    return value->size();
}

std::vector<Reader> Reader::elements(std::size_t low, std::size_t high, std::string_view allowed) const {
    const std::size_t size = count(low, high, allowed);
    std::vector<Reader> readers;
    for (std::size_t i = 0; i < size; ++i) readers.push_back(element(i));
    return readers;
}

float Reader::number(Range range) const {
    const std::string allowed = fmt::format("allowed is {}", describeRange(range));
    if (!value->is_number()) fail(describe(), allowed);

    // Beyond the range of float the conversion itself would be undefined.
    const double wide = value->get<double>();
    if (!(std::abs(wide) <= double{std::numeric_limits<float>::max()})) fail(describe(), allowed);
    const float narrow = static_cast<float>(wide);
    if (!contains(range, narrow)) fail(describe(), allowed);
    return narrow;
}

double Reader::precise() const {
    (void)number();
    return value->get<double>();
}

uint Reader::integer(uint low, uint high) const {
    const double wide = value->is_number() ? value->get<double>() : -1;
    if (!(wide >= low && wide <= high && wide == std::floor(wide)))
        fail(describe(), fmt::format("allowed is an integer from {} to {}", low, high));
    return static_cast<uint>(wide);
}

glm::dvec2 Reader::pair(Range range) const {
    const std::vector<Reader> parts = elements(2, 2, "an array of 2 numbers");
    return {parts[0].number(range), parts[1].number(range)};
}

vec3 Reader::vector(Range range) const {
    const std::vector<Reader> parts = elements(3, 3, "an array of 3 numbers, [x, y, z]");
    return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

glm::dvec3 Reader::place() const {
    const std::vector<Reader> parts = elements(3, 3, "an array of 3 numbers, [x, y, z]");
    return {parts[0].precise(), parts[1].precise(), parts[2].precise()};
}

vec3 Reader::color(Range range) const {
    if (value->is_number()) return vec3{number(range)};
    const std::vector<Reader> parts = elements(3, 3, "a colour: 3 numbers, [red, green, blue], or one for a grey");
    return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

bool Reader::boolean() const {
    if (!value->is_boolean()) fail(describe(), "allowed is true or false");
    return value->get<bool>();
}

std::string Reader::text() const {
    if (!value->is_string()) fail(describe(), "allowed is a string");
    return value->get<std::string>();
}

std::size_t Reader::choice(const std::vector<std::string_view>& names) const {
    const std::vector<std::string> words(names.begin(), names.end());
    const std::string word = value->is_string() ? value->get<std::string>() : "";
    const auto found = std::ranges::find(words, word);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());

    const std::string nearest = nearestWord(word, words);
    const std::string hint = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
    fail(describe(), fmt::format("{}allowed is {}", hint, quotedList(words)));
}

} // namespace vkpm
