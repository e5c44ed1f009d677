/// Reading of OBJ text, line by line.
#include "scene/obj.h"
#include "scene/text.h"
#include "scene/triangulate.h"
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <utility>

namespace vkpm {

namespace {

/// Takes the next word off a line; empty at its end and before a comment.
std::string_view takeWord(std::string_view& line) {
    const std::size_t start = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t", start), line.size());
    const std::string_view word = line.substr(start, end - start);
    line.remove_prefix(end);
    return word.starts_with('#') ? "" : word;
}

/// Takes the next line off a text; lines end with a line feed, a carriage return or both.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    const bool both = text.substr(end).starts_with("\r\n");
    text.remove_prefix(std::min(end + (both ? 2 : 1), text.size()));
    return line;
}

/// What programs write for a number that is none: nan, -nan(ind), 1.#QNAN, inf ...
bool isNotANumber(std::string_view word) {
    std::string small;
    for (const char c : word) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return small.find("nan") != small.npos || small.find("inf") != small.npos || small.find("#ind") != small.npos;
}

std::string_view takeIndex(std::string_view& word) {
    const std::size_t end = std::min(word.find('/'), word.size());
    const std::string_view index = word.substr(0, end);
    word.remove_prefix(std::min(end + 1, word.size()));
    return index;
}

/// Reads one file; indices count from 1, or back from the latest element if negative.
class ObjReader {
public:
    explicit ObjReader(const std::filesystem::path& path) : file{path} {}

    IndexedMesh read(std::string_view text) {
        for (std::size_t next = 1; !text.empty(); ++next) {
            line = next;
            std::string_view whole = takeLine(text);
            if (whole.ends_with('\\')) {
                joined.clear();
                for (; whole.ends_with('\\') && !text.empty(); ++next) {
                    joined.append(whole.substr(0, whole.size() - 1)) += ' ';
                    whole = takeLine(text);
                }
                joined.append(whole.substr(0, whole.size() - whole.ends_with('\\')));
                whole = joined;
            }
            readLine(whole);
        }
        if (faces.empty())
            fail(std::max<std::size_t>(line, 1), "the mesh has no faces", "lines of the form \"f 1 2 3\" are needed");
        for (const Face& face : faces) addTriangles(face);
        return std::move(obj);
    }

private:
    /// Corners up to `end`, after those of the face before; they may refer to what comes later in the file.
    struct Face {
        std::size_t end;
        std::size_t line;
        uint material;
    };

    [[noreturn]] void fail(std::size_t where, std::string_view found, std::string_view allowed) const {
        refuseFile(file, fmt::format(":{}", where), found, allowed);
    }

    void readLine(std::string_view rest) {
        const std::string_view keyword = takeWord(rest);
        if (keyword == "v") {
            obj.vertices.push_back(readNumbers(rest, 3));
            if (!isFinite(obj.vertices.back()))
                unsound[obj.vertices.size() - 1] = {
                    line, std::string(rest.substr(std::min(rest.find_first_not_of(" \t"), rest.size())).substr(0, 60))};
        } else if (keyword == "vn") {
            obj.normals.push_back(vec3{readNumbers(rest, 3)});
            if (!isFinite(glm::dvec3{obj.normals.back()}))
                obj.wrongNormals[obj.normals.size() - 1] = fmt::format(":{}", line);
        } else if (keyword == "vt") {
            obj.coordinates[0].emplace_back(readNumbers(rest, 1));
        } else if (keyword == "usemtl") {
            const std::string_view name = rest.substr(std::min(rest.find_first_not_of(" \t"), rest.size()));
            material = name.substr(0, name.find_last_not_of(" \t") + 1);
            materialIsNew = true;
        } else if (keyword == "f") {
            readFace(rest);
        }
    }

    static bool isFinite(glm::dvec3 v) { return std::isfinite(v.x + v.y + v.z); }

    /// Three numbers, of which those after the first `needed` may be absent; those beyond the range of float are
    /// infinite.
    glm::dvec3 readNumbers(std::string_view rest, int needed) const {
        glm::dvec3 numbers{0};
        for (int i = 0; i < 3; ++i) {
            std::string_view word = takeWord(rest);
            if (word.empty() && i >= needed) break;
            const std::string_view found = word;
            if (word.starts_with('+')) word.remove_prefix(1);
            double value = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            const bool tiny = error == std::errc::result_out_of_range && std::abs(value) < 1; // underflows to 0
            const bool huge =
                error == std::errc::result_out_of_range || std::abs(value) > double{std::numeric_limits<float>::max()};
            const bool isNumber =
                (error == std::errc{} || error == std::errc::result_out_of_range) && end == word.data() + word.size();
            if (!isNumber && !isNotANumber(word))
                fail(line, fmt::format("found \"{}\" as a coordinate", printable(found, 60)),
                     "allowed are three finite numbers");
            numbers[i] = !isNumber ? std::numeric_limits<double>::quiet_NaN()
                         : tiny    ? 0
                         : huge    ? std::numeric_limits<double>::infinity()
                                   : value;
        }
        return numbers;
    }

    void readFace(std::string_view rest) {
        const std::size_t first = corners.size();
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            const std::string_view whole = word;
            const uint vertex = readIndex(takeIndex(word), whole, obj.vertices.size());
            const std::string_view place = takeIndex(word), normal = takeIndex(word);
            const auto optional = [&](std::string_view index, std::size_t count) {
                return index.empty() || index == "0" ? NONE : readIndex(index, whole, count);
            };
            corners.push_back(
                {vertex, optional(normal, obj.normals.size()), optional(place, obj.coordinates[0].size())});
        }
        const std::size_t count = corners.size() - first;
        if (count < 3) {
            corners.resize(first);
            ++obj.skippedFaces;
            return;
        }
        if (count > maxCorners)
            fail(line, fmt::format("a face of {} corners", count),
                 fmt::format("allowed are {}; cut it into several", maxCorners));
        if (std::exchange(materialIsNew, false)) {
            const auto known = std::ranges::find(obj.materials, material);
            currentMaterial = static_cast<uint>(known - obj.materials.begin());
            if (known == obj.materials.end()) obj.materials.push_back(material);
        }
        faces.push_back({corners.size(), line, currentMaterial});
    }

    uint readIndex(std::string_view digits, std::string_view corner, std::size_t count) const {
        std::int32_t index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc{} || end != digits.data() + digits.size() || index == 0 ||
            std::int64_t{index} < -static_cast<std::int64_t>(count))
            fail(line,
                 fmt::format("found \"{}\" as a corner of a face, after {} elements", printable(corner, 60), count),
                 "allowed are vertex, vertex/texture, vertex//normal or vertex/texture/normal, counted from 1");
        return index > 0 ? static_cast<uint>(index - 1) : static_cast<uint>(std::int64_t(count) + index);
    }

    void addTriangles(const Face& face) {
        const std::span<const IndexedMesh::Corner> polygon = std::span{corners}.subspan(begin, face.end - begin);
        begin = face.end;
        points.clear();
        for (const IndexedMesh::Corner corner : polygon) {
            requireIndex(corner.vertex, obj.vertices.size(), "vertex", face);
            if (!isFinite(obj.vertices[corner.vertex])) refuseVertex(corner.vertex);
            if (corner.normal != NONE) requireIndex(corner.normal, obj.normals.size(), "normal", face);
            if (corner.coordinates != NONE)
                requireIndex(corner.coordinates, obj.coordinates[0].size(), "texture coordinates", face);
            points.push_back(obj.vertices[corner.vertex]);
        }
        for (const auto& [a, b, c] : triangulate(points)) {
            obj.triangles.push_back({polygon[a], polygon[b], polygon[c]});
            if (!obj.materials.empty()) obj.materialOfTriangle.push_back(face.material);
        }
    }

    void requireIndex(uint index, std::size_t count, std::string_view kind, const Face& face) const {
        if (index >= count)
            fail(face.line, fmt::format("a face refers to {} {}", kind, std::uint64_t{index} + 1),
                 fmt::format("the file has {}", count));
    }

    [[noreturn]] void refuseVertex(uint index) const {
        const auto& [where, text] = unsound.at(index);
        fail(where, fmt::format("found \"{}\" as coordinates of a vertex that a face uses", printable(text)),
             "allowed are three finite numbers");
    }

    const std::filesystem::path& file;
    std::size_t line = 0;
    std::string joined; // of continued lines
    std::string material;
    bool materialIsNew = false; // no face has it yet
    uint currentMaterial = NONE;
    std::map<std::size_t, std::pair<std::size_t, std::string>> unsound; // vertices that are not finite: line and text
    IndexedMesh obj;
    std::vector<IndexedMesh::Corner> corners; // of all faces
    std::vector<Face> faces;
    std::size_t begin = 0;          // first corner of the face whose triangles are next
    std::vector<glm::dvec3> points; // its corners
};

} // namespace

IndexedMesh readObj(const std::filesystem::path& file, std::string_view text) { return ObjReader{file}.read(text); }

} // namespace vkpm
