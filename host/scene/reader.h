/// A typed reader of JSON: a cursor that knows its file, its place and which keys were asked for.
#pragma once
#include "shared.h"
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

/// Numbers that are allowed; `low` itself is not if `aboveLow`.
struct Range {
    float low = std::numeric_limits<float>::lowest();
    float high = std::numeric_limits<float>::max();
    bool aboveLow = false;
};
constexpr Range anyNumber{};
constexpr Range positive{0, std::numeric_limits<float>::max(), true};
constexpr Range notNegative{0, std::numeric_limits<float>::max()};
constexpr Range fraction{0, 1};

/// The JSON value of a text. Throws InputError with file:line:column for syntax, and with a JSON pointer for repeated
/// keys and for nesting beyond 64 levels.
nlohmann::json parseJson(const std::filesystem::path& file, const std::string& text);

/// A place in a JSON value; both the value and the path must outlive it. Every function that reads throws InputError,
/// "file: /json/pointer: found; allowed".
class Reader {
public:
    Reader(const std::filesystem::path& path, const nlohmann::json& root) : file{&path}, value{&root} {}

    [[noreturn]] void fail(std::string_view found, std::string_view allowed) const;
    void warn(std::vector<std::string>& warnings, std::string_view message) const;

    /// Members of an object; asking for a key makes it known.
    Reader at(std::string_view key);
    std::optional<Reader> find(std::string_view key);
    std::vector<std::string> keys() const;
    /// Fails at the first key that was never asked for.
    void finish() const;

    /// Elements of an array of `low` to `high` elements: how many, one of them, all at once.
    std::size_t count(std::size_t low, std::size_t high, std::string_view allowed) const;
    Reader element(std::size_t index) const { return child(std::to_string(index), (*value)[index]); }
    std::vector<Reader> elements(std::size_t low, std::size_t high, std::string_view allowed) const;

    float number(Range range = anyNumber) const;
    double precise() const; // a number within the range of float, in double precision
    uint integer(uint low, uint high) const;
    glm::dvec2 pair(Range range) const;
    vec3 vector(Range range = anyNumber) const;
    glm::dvec3 place() const;      // three numbers in double precision
    vec3 color(Range range) const; // three numbers, or one for a grey
    bool boolean() const;
    std::string text() const;
    std::size_t choice(const std::vector<std::string_view>& names) const; // index of the name found
    bool isNumber() const { return value->is_number(); }
    bool isText() const { return value->is_string(); }
    bool isObject() const { return value->is_object(); }

    std::string describe() const; // the value found, in words
    const std::filesystem::path& path() const { return *file; }

private:
    Reader child(std::string_view key, const nlohmann::json& member) const;
    const nlohmann::json& object() const;
    [[noreturn]] void failUnknown(std::string_view key) const;

    const std::filesystem::path* file;
    const nlohmann::json* value;
    std::string pointer;
    std::vector<std::string> known;
};

} // namespace vkpm
