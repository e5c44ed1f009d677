/// A check of OBJ text line by line: vertices, normals and the indices of faces.
#include "scene/obj_check.h"
#include "scene/scene.h"
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace vkpm {

namespace {

/// Takes the next word off a line; empty at its end.
std::string_view takeWord(std::string_view& line) {
    const std::size_t start = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\r", start), line.size());
    const std::string_view word = line.substr(start, end - start);
    line.remove_prefix(end);
    return word;
}

/// Checks one file; indices count from 1, or back from the latest element if negative.
class ObjCheck {
public:
    explicit ObjCheck(const std::filesystem::path& path) : file{path} {}

    void run(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line;
            checkLine(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (faces == 0)
            throw InputError(
                fmt::format("{}: the mesh has no faces; lines of the form \"f 1 2 3\" are needed", file.string()));
        checkLargest(vertexUse, vertices, "vertex");
        checkLargest(normalUse, normals, "normal");
    }

private:
    struct Use {
        long index = 0; // the largest
        long line = 0;
    };

    [[noreturn]] void fail(long where, std::string_view found, std::string_view allowed) const {
        throw InputError(fmt::format("{}:{}: {}; {}", file.string(), where, found, allowed));
    }

    void checkLine(std::string_view rest) {
        const std::string_view keyword = takeWord(rest);
        if (keyword == "v") {
            checkNumbers(rest);
            ++vertices;
        } else if (keyword == "vn") {
            checkNumbers(rest);
            ++normals;
        } else if (keyword == "f") {
            checkFace(rest);
        }
    }

    void checkNumbers(std::string_view rest) const {
        for (int i = 0; i < 3; ++i) {
            std::string_view word = takeWord(rest);
            const std::string_view found = word;
            if (word.starts_with('+')) word.remove_prefix(1);
            float value = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
                fail(line, fmt::format("found \"{}\" as a coordinate", found), "allowed are three finite numbers");
        }
    }

    void checkFace(std::string_view rest) {
        long corners = 0;
        for (std::string_view word = takeWord(rest); !word.empty() && word[0] != '#';
             word = takeWord(rest), ++corners) {
            const std::string_view whole = word;
            checkIndex(takeIndex(word), whole, vertices, vertexUse);
            takeIndex(word); // of texture coordinates, which are not used
            const std::string_view normal = takeIndex(word);
            if (!normal.empty()) checkIndex(normal, whole, normals, normalUse);
        }
        if (corners < 3) fail(line, fmt::format("a face of {} corners", corners), "a face needs at least 3");
        ++faces;
    }

    static std::string_view takeIndex(std::string_view& word) {
        const std::size_t end = std::min(word.find('/'), word.size());
        const std::string_view index = word.substr(0, end);
        word.remove_prefix(std::min(end + 1, word.size()));
        return index;
    }

    void checkIndex(std::string_view digits, std::string_view corner, long count, Use& use) const {
        long index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc{} || end != digits.data() + digits.size() || index == 0 || index < -count)
            fail(line, fmt::format("found \"{}\" as a corner of a face, after {} elements", corner, count),
                 "allowed are vertex, vertex/texture, vertex//normal or vertex/texture/normal, counted from 1");
        if (index > use.index) use = {index, line};
    }

    void checkLargest(const Use& use, long count, std::string_view kind) const {
        if (use.index > count)
            fail(use.line, fmt::format("a face refers to {} {}", kind, use.index),
                 fmt::format("the file has {}", count));
    }

    const std::filesystem::path& file;
    long line = 0;
    long vertices = 0;
    long normals = 0;
    long faces = 0;
    Use vertexUse;
    Use normalUse;
};

} // namespace

void checkObj(const std::filesystem::path& file, const std::string& text) { ObjCheck{file}.run(text); }

} // namespace vkpm
