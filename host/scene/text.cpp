/// Reading of text files, and messages about them.
#include "scene/text.h"
#include "error.h"
#include "scene/hash.h"
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <numeric>

namespace vkpm {
namespace fs = std::filesystem;

namespace {

/// Bytes of the UTF-8 character (RFC 3629) at the start of a text; 0 if there is none, or a control character.
std::size_t characterLength(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool isLong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90) ||
                        (first == 0xc2 && byte(1) < 0xa0) || first < 0xc2;
    const bool isOutside = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90) || first > 0xf4;
    return isLong || isOutside ? 0 : length;
}

/// For what is not ASCII the function of C is undefined.
int toLower(char c) { return std::tolower(static_cast<unsigned char>(c)); }

/// Levenshtein's distance: insertions, deletions and substitutions that turn one word into the other.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (toLower(a[i]) != toLower(b[j]));
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

[[noreturn]] void refuseZero(const fs::path& file, const std::string& text, std::size_t place) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    refuseFile(file, fmt::format(":{}", line), "found a byte 0", "allowed is text in UTF-8");
}

/// The contents of a file; of text, where it ends is known by the first byte 0 at the latest.
std::string readPieces(const fs::path& file, std::uint64_t most, std::string_view advice, bool isText) {
    const auto refuseSize = [&] {
        refuseFile(file, ":1", fmt::format("the file has more than {} MiB", most >> 20), advice);
    };
    std::error_code unknown;
    const std::uint64_t bytes = fs::file_size(file, unknown);
    if (!unknown && bytes > most) refuseSize();

    // Devices and pipes do not say how long they are.
    std::ifstream stream{file, std::ios::binary};
    std::string text;
    if (!unknown && !isText) text.reserve(bytes);
    std::array<char, 1 << 16> piece;
    while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0) {
        text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > most) refuseSize();
        if (!isText) continue;
        if (const void* zero = std::memchr(piece.data(), 0, static_cast<std::size_t>(stream.gcount())))
            refuseZero(file, text,
                       text.size() -
                           static_cast<std::size_t>(stream.gcount() - (static_cast<const char*>(zero) - piece.data())));
    }
    if (stream.bad() || !stream.eof())
        throw std::runtime_error(fmt::format("{}: read: {}", file.string(), std::strerror(errno)));
    return text;
}

} // namespace

std::string fileProblem(const fs::path& file, bool regular) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status))
        return error && status.type() == fs::file_type::none
                   ? fmt::format("the file cannot be found ({})", error.message())
                   : "the file does not exist";
    if (fs::is_directory(status)) return "this is a folder, not a file";
    if (regular && !fs::is_regular_file(status)) return "this is a device or a pipe, not a file";
    if (!fs::is_regular_file(status)) return ""; // to open a pipe twice would lose what it holds
    errno = 0;
    if (!std::ifstream{file}) return fmt::format("the file cannot be opened ({})", std::strerror(errno));
    return "";
}

std::string readBytes(const fs::path& file, std::uint64_t most, std::string_view advice, FileRead* read) {
    std::string bytes = readPieces(file, most, advice, false);
    if (read) *read = {file, hashText(bytes)};
    return bytes;
}

std::string readText(const fs::path& file, std::uint64_t most, std::string_view advice, FileRead* read) {
    std::string text = readPieces(file, most, advice, true);
    if (read) *read = {file, hashText(text)};
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    return text;
}

std::string printable(std::string_view text, std::size_t most) {
    const bool isLong = text.size() > most;
    const std::string_view end = isLong ? text.substr(text.size() - most / 4) : "";
    if (isLong) text = text.substr(0, most - most / 4);
    std::string shown;
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t length = characterLength(rest);
        if (length > 0) shown += rest.substr(0, length);
        else shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(rest[0]));
        rest.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return isLong ? shown + "..." + printable(end, end.size()) : shown;
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
    std::string nearest;
    std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > word.size() + least) continue;
        const std::size_t distance = editDistance(word.substr(0, 64), candidate);
        if (distance < least && distance < candidate.size()) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string quotedList(const std::vector<std::string>& words) {
    std::string list;
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i == most) return list + fmt::format(" and {} more", words.size() - most);
        if (i > 0) list += i + 1 == words.size() ? " or " : ", ";
        list += fmt::format("\"{}\"", printable(words[i], 40));
    }
    return list;
}

void refuseFile(const fs::path& file, std::string_view place, std::string_view found, std::string_view allowed) {
    throw InputError(fmt::format("{}{}: {}; {}", printable(file.string(), 4096), printable(place), printable(found),
                                 printable(allowed, 600)));
}

bool hasEnding(const std::filesystem::path& file, std::string_view ending) {
    return std::ranges::equal(file.extension().string(), ending, {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

} // namespace vkpm
