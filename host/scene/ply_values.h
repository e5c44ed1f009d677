/// The values of a PLY file one after the other, as numbers in double precision.
#pragma once
#include "scene/ply_header.h"
#include "scene/text.h"
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <fmt/format.h>

namespace vkpm {

/// Words of text, between blanks.
class PlyWords {
public:
    PlyWords(const std::filesystem::path& path, std::string_view all, const PlyHeader& header)
        : file{path}, text{all}, at{header.bytes}, line{header.lines + 1} {}

    static std::uint64_t leastBytes(PlyType) { return 2; }      // a digit and a blank
    std::uint64_t rest() const { return text.size() - at + 1; } // the last blank may be missing
    static std::string placeOf(std::uint64_t mark) { return fmt::format(":{}", mark); }
    std::uint64_t mark() { return skipBlanks(), line; } // where the next value stands

    double number(PlyType) {
        skipBlanks();
        const char* const begin = text.data() + at;
        double value = 0;
        auto [end, error] = std::from_chars(begin + (begin < stop() && *begin == '+'), stop(), value);
        if (error == std::errc::result_out_of_range && std::abs(value) < 1) value = 0;
        else if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
        else if (error != std::errc{} || (end < stop() && !isBlank(*end))) refuseWord();
        at = static_cast<std::size_t>(end - text.data());
        return value;
    }

private:
    static bool isBlank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
    const char* stop() const { return text.data() + text.size(); }

    void skipBlanks() {
        for (; at < text.size() && isBlank(text[at]); ++at)
            line += text[at] == '\n' || (text[at] == '\r' && next() != '\n');
    }
    char next() const { return at + 1 < text.size() ? text[at + 1] : '\0'; }

    [[noreturn]] void refuseWord() const {
        const std::string_view rest = text.substr(at, 200);
        const std::string_view word = rest.substr(0, rest.find_first_of(" \n\t\r"));
        refuseFile(file, placeOf(line),
                   word.empty() ? "the file ends here" : fmt::format("found \"{}\"", printable(word, 60)),
                   "its header promises a number");
    }

    const std::filesystem::path& file;
    std::string_view text;
    std::size_t at, line;
};

/// Numbers as the processor has them, or with their bytes in the other order.
template <std::endian order> class PlyBytes {
public:
    PlyBytes(const std::filesystem::path& path, std::string_view all, const PlyHeader& header)
        : file{path}, bytes{all}, at{header.bytes} {}

    static std::uint64_t leastBytes(PlyType type) { return plyBytes(type); }
    std::uint64_t rest() const { return bytes.size() - at; }
    static std::string placeOf(std::uint64_t mark) { return fmt::format(": byte {}", mark); }
    std::uint64_t mark() const { return at; }

    double number(PlyType type) {
        switch (type) {
        case PlyType::int8:
            return take<std::int8_t>();
        case PlyType::uint8:
            return take<std::uint8_t>();
        case PlyType::int16:
            return take<std::int16_t>();
        case PlyType::uint16:
            return take<std::uint16_t>();
        case PlyType::int32:
            return take<std::int32_t>();
        case PlyType::uint32:
            return take<std::uint32_t>();
        case PlyType::float32:
            return double{take<float>()};
        default:
            return take<double>();
        }
    }

private:
    template <class T> T take() {
        if (rest() < sizeof(T))
            refuseFile(file, placeOf(at), "the file ends here", "its header promises more elements");
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
        if constexpr (order != std::endian::native) std::ranges::reverse(raw);
        at += sizeof(T);
        return std::bit_cast<T>(raw);
    }

    const std::filesystem::path& file;
    std::string_view bytes;
    std::size_t at;
};

} // namespace vkpm
