/// Reading of PLY headers, line by line.
#include "scene/ply_header.h"
#include "scene/text.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <sstream>

namespace vkpm {

namespace {

constexpr std::size_t maxHeaderLine = 4096;
constexpr std::array<std::pair<const char*, PlyType>, 16> plyTypes{{{"char", PlyType::int8},
                                                                    {"uchar", PlyType::uint8},
                                                                    {"short", PlyType::int16},
                                                                    {"ushort", PlyType::uint16},
                                                                    {"int", PlyType::int32},
                                                                    {"uint", PlyType::uint32},
                                                                    {"float", PlyType::float32},
                                                                    {"double", PlyType::float64},
                                                                    {"int8", PlyType::int8},
                                                                    {"uint8", PlyType::uint8},
                                                                    {"int16", PlyType::int16},
                                                                    {"uint16", PlyType::uint16},
                                                                    {"int32", PlyType::int32},
                                                                    {"uint32", PlyType::uint32},
                                                                    {"float32", PlyType::float32},
                                                                    {"float64", PlyType::float64}}};

class PlyHeaderReader {
public:
    PlyHeaderReader(const std::filesystem::path& path, std::string_view all) : file{path}, bytes{all} {}

    PlyHeader read() {
        if (bytes.starts_with("\xEF\xBB\xBF")) header.bytes = 3;
        const std::vector<std::string> first = takeWords();
        if (first.size() != 1 || first[0] != "ply")
            fail(fmt::format("found \"{}\"", first.empty() ? "" : printable(first[0], 60)),
                 "a PLY file begins with the line \"ply\"");
        bool hasFormat = false;
        for (;;) {
            const std::vector<std::string> words = takeWords();
            const std::string keyword = words.empty() ? "" : words[0];
            if (keyword == "end_header") break;
            if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
            if (keyword == "format") readFormat(words), hasFormat = true;
            else if (keyword == "element") readElement(words);
            else if (keyword == "property") readProperty(words);
            else
                fail(fmt::format("found \"{}\"", printable(keyword, 60)),
                     "allowed are \"format\", \"element\", \"property\", \"comment\", \"obj_info\" and \"end_header\"");
        }
        if (!hasFormat) fail("the header has no line \"format\"", "such as \"format binary_little_endian 1.0\"");
        return std::move(header);
    }

private:
    [[noreturn]] void fail(std::string_view found, std::string_view allowed) const {
        refuseFile(file, fmt::format(":{}", header.lines), found, allowed);
    }

    /// The words of the next line, which ends with a line feed, a carriage return or both.
    std::vector<std::string> takeWords() {
        ++header.lines;
        const std::string_view rest = bytes.substr(header.bytes, maxHeaderLine);
        const std::size_t end = rest.find_first_of("\r\n");
        if (end == rest.npos)
            fail(rest.size() < maxHeaderLine ? "the file ends before its header does" : "found a very long line",
                 "a header ends with the line \"end_header\"");
        header.bytes += end + (rest.substr(end).starts_with("\r\n") ? 2 : 1);
        std::istringstream stream{std::string{rest.substr(0, end)}};
        std::vector<std::string> words;
        for (std::string word; stream >> word;) words.push_back(word);
        return words;
    }

    void readFormat(const std::vector<std::string>& words) {
        constexpr std::array names{"ascii", "binary_little_endian", "binary_big_endian"};
        const auto* const name = words.size() < 2 ? names.end() : std::ranges::find(names, words[1]);
        if (name == names.end() || words.size() != 3 || words[2] != "1.0")
            fail(fmt::format("found \"{}{}{}\" as format", words.size() < 2 ? "" : printable(words[1], 60),
                             words.size() < 3 ? "" : " ", words.size() < 3 ? "" : printable(words[2], 60)),
                 "allowed are \"ascii 1.0\", \"binary_little_endian 1.0\" and \"binary_big_endian 1.0\"");
        header.format = static_cast<PlyFormat>(name - names.begin());
    }

    void readElement(const std::vector<std::string>& words) {
        PlyElement element{.line = header.lines};
        const std::string number = words.size() == 3 ? words[2] : "";
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), element.count);
        if (words.size() != 3 || error != std::errc{} || end != number.data() + number.size())
            fail("found an element without a count",
                 "allowed is \"element\", a name and a number, as \"element vertex 8\"");
        element.name = words[1];
        for (const PlyElement& other : header.elements)
            if (other.name == element.name)
                fail(fmt::format("found the element \"{}\" twice", printable(element.name, 60)), "give it once");
        header.elements.push_back(std::move(element));
    }

    void readProperty(const std::vector<std::string>& words) {
        if (header.elements.empty()) fail("found a property of no element", "a line \"element\" comes before it");
        const bool isList = words.size() > 1 && words[1] == "list";
        if (words.size() != (isList ? 5 : 3))
            fail(fmt::format("found a property of {} words", words.size()),
                 "allowed is \"property\", a type and a name, or \"property list\", two types and a name");
        PlyProperty property{.name = words.back(), .type = typeOf(words[isList ? 3 : 1])};
        if (isList) property.countType = typeOf(words[2]);
        if (isList && *property.countType >= PlyType::float32)
            fail("found a list whose length is no whole number", "allowed are the types of whole numbers");
        if (header.elements.back().find({property.name}) != NONE)
            fail(fmt::format("found the property \"{}\" twice", printable(property.name, 60)), "give it once");
        header.elements.back().properties.push_back(std::move(property));
    }

    PlyType typeOf(const std::string& word) const {
        for (const auto& [name, type] : plyTypes)
            if (word == name) return type;
        std::vector<std::string> names;
        for (const auto& [name, type] : plyTypes) names.emplace_back(name);
        fail(fmt::format("found \"{}\" as type", printable(word, 60)), "allowed is " + quotedList(names));
    }

    const std::filesystem::path& file;
    std::string_view bytes;
    PlyHeader header;
};

} // namespace

uint PlyElement::find(std::initializer_list<std::string_view> names) const {
    for (uint i = 0; i < properties.size(); ++i)
        if (std::ranges::find(names, properties[i].name) != names.end()) return i;
    return NONE;
}

std::size_t plyBytes(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

PlyHeader readPlyHeader(const std::filesystem::path& file, std::string_view bytes) {
    return PlyHeaderReader{file, bytes}.read();
}

} // namespace vkpm
