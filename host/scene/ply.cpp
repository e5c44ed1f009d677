/// Reading of PLY elements: vertices first, then the faces that refer to them.
#include "scene/ply.h"
#include "scene/ply_values.h"
#include "scene/textures.h"
#include "scene/triangulate.h"
#include <cmath>
#include <map>
#include <utility>

namespace vkpm {
using glm::dvec3;

namespace {

/// Reads the values of one file from words or bytes. A file whose faces come before its vertices is read twice.
template <class Values> class PlyReader {
public:
    PlyReader(const std::filesystem::path& path, std::string_view bytes, const PlyHeader& all)
        : file{path}, whole{bytes}, header{all} {}

    IndexedMesh read() {
        const std::size_t vertices = indexOf("vertex"), faces = indexOf("face");
        values.emplace(file, whole, header);
        if (faces < vertices) {
            readElements(vertices + 1, NONE);
            values.emplace(file, whole, header);
        }
        readElements(std::max(vertices, faces) + 1, faces);
        if (mesh.triangles.empty())
            fail(Values::placeOf(values->mark()), "the mesh has no faces",
                 "faces of at least three vertices are needed");
        return std::move(mesh);
    }

private:
    [[noreturn]] void fail(const std::string& place, std::string_view found, std::string_view allowed) const {
        refuseFile(file, place, found, allowed);
    }

    std::size_t indexOf(std::string_view name) const {
        std::vector<std::string> names;
        for (const PlyElement& element : header.elements) names.push_back(element.name);
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            fail(fmt::format(":{}", header.lines), fmt::format("the file has no element \"{}\"", name),
                 names.empty() ? "it has none at all" : "it has " + quotedList(names));
        return static_cast<std::size_t>(found - names.begin());
    }

    /// Reads the elements before `end`, faces only if they are number `faces`.
    void readElements(std::size_t end, std::size_t faces) {
        for (std::size_t i = 0; i < end; ++i) {
            const PlyElement& element = header.elements[i];
            requireBytes(element);
            if (element.name == "vertex" && mesh.vertices.empty()) readVertices(element);
            else if (i == faces) readFaces(element);
            else skip(element);
        }
    }

    /// What is promised must fit into the file, before memory is taken for it.
    void requireBytes(const PlyElement& element) const {
        std::uint64_t least = 0;
        for (const PlyProperty& property : element.properties)
            least += Values::leastBytes(property.countType.value_or(property.type));
        const std::uint64_t room = least == 0 ? 0 : values->rest() / least;
        if ((least > 0 && element.count > room) || element.count >= NONE)
            fail(fmt::format(":{}", element.line),
                 fmt::format("found {} of the element \"{}\"", element.count, printable(element.name, 60)),
                 fmt::format("the file has bytes for {} at most", room));
    }

    void skip(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
            for (const PlyProperty& property : element.properties) skipProperty(property);
    }

    void skipProperty(const PlyProperty& property) {
        for (std::uint64_t left = property.countType ? takeCount(property) : 1; left > 0; --left)
            values->number(property.type);
    }

    std::uint64_t takeCount(const PlyProperty& list) {
        const std::uint64_t mark = values->mark();
        const double count = values->number(*list.countType);
        if (!(count >= 0 && count == std::floor(count) && count <= double(values->rest())))
            fail(Values::placeOf(mark), fmt::format("found a list of {} values", count),
                 "allowed are as many as the file has");
        return static_cast<std::uint64_t>(count);
    }

    void readVertices(const PlyElement& element) {
        const std::array points{scalar(element, "x"), scalar(element, "y"), scalar(element, "z")};
        const std::array normals{element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
        const bool hasNormals = std::ranges::find(normals, NONE) == normals.end();
        const std::array places{element.find({"s", "u", "texture_u", "texture_s"}),
                                element.find({"t", "v", "texture_v", "texture_t"})};
        const auto isNumber = [&](uint i) { return i != NONE && !element.properties[i].countType; };
        const bool hasCoordinates = isNumber(places[0]) && isNumber(places[1]);
        const std::array colors{element.find({"red", "r", "diffuse_red"}),
                                element.find({"green", "g", "diffuse_green"}),
                                element.find({"blue", "b", "diffuse_blue"})};
        const bool hasColors = std::ranges::all_of(colors, isNumber);
        if (!hasColors && colors[0] != NONE) mesh.leftOut.emplace_back("the colours of its vertices");
        mesh.vertices.reserve(element.count);
        if (hasNormals) mesh.normals.reserve(element.count);
        std::vector<double> row(element.properties.size());
        for (std::uint64_t i = 0; i < element.count; ++i) {
            const std::uint64_t mark = values->mark();
            for (std::size_t k = 0; k < row.size(); ++k)
                if (element.properties[k].countType) skipProperty(element.properties[k]);
                else row[k] = inRange(values->number(element.properties[k].type));
            mesh.vertices.emplace_back(row[points[0]], row[points[1]], row[points[2]]);
            if (!allFinite(mesh.vertices.back())) wrongVertices[i] = mark;
            if (hasCoordinates) mesh.coordinates[0].emplace_back(row[places[0]], row[places[1]]);
            if (hasColors) {
                mesh.colors.emplace_back();
                for (int c = 0; c < 3; ++c)
                    mesh.colors.back()[c] =
                        colorOf(row[colors[std::size_t(c)]], element.properties[colors[std::size_t(c)]].type);
                if (!allFinite(mesh.colors.back()))
                    fail(Values::placeOf(mark), "found a colour that is not finite", "allowed are finite numbers");
            }
            if (!hasNormals) continue;
            mesh.normals.emplace_back(row[normals[0]], row[normals[1]], row[normals[2]]);
            if (!allFinite(mesh.normals.back())) mesh.wrongNormals[i] = Values::placeOf(mark);
        }
    }

    uint scalar(const PlyElement& element, std::string_view name) const {
        const uint index = element.find({name});
        if (index == NONE || element.properties[index].countType)
            fail(fmt::format(":{}", element.line),
                 fmt::format("vertices have {} \"{}\"", index == NONE ? "no property" : "a list", name),
                 "the numbers x, y and z are needed");
        return index;
    }

    template <class Vector> static bool allFinite(const Vector& v) { return std::isfinite(v.x + v.y + v.z); }

    /// Whole numbers are by the curve of sRGB, up to the greatest of their type; others are linear.
    static float colorOf(double x, PlyType type) {
        if (type == PlyType::float32 || type == PlyType::float64) return static_cast<float>(std::clamp(x, 0.0, 1.0));
        return static_cast<float>(linearOfSrgb(std::clamp(x / (plyBytes(type) == 1 ? 255 : 65535), 0.0, 1.0)));
    }

    /// What is beyond the range of float is infinite.
    static double inRange(double x) {
        return std::abs(x) > double{std::numeric_limits<float>::max()} ? std::copysign(INFINITY, x) : x;
    }

    void readFaces(const PlyElement& element) {
        const uint list = element.find({"vertex_indices", "vertex_index"});
        if (list == NONE || !element.properties[list].countType)
            fail(fmt::format(":{}", element.line), "faces have no list \"vertex_indices\"",
                 "allowed is, for one, \"property list uchar int vertex_indices\"");
        mesh.triangles.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (std::size_t k = 0; k < element.properties.size(); ++k)
                if (k == list) readFace(element.properties[k]);
                else skipProperty(element.properties[k]);
    }

    void readFace(const PlyProperty& list) {
        const std::uint64_t mark = values->mark(), count = takeCount(list);
        if (count > maxCorners)
            fail(Values::placeOf(mark), fmt::format("a face of {} corners", count),
                 fmt::format("allowed are {}; cut it into several", maxCorners));
        polygon.clear();
        points.clear();
        for (std::uint64_t i = 0; i < count; ++i) {
            polygon.push_back(takeIndex(list, mark));
            points.push_back(mesh.vertices[polygon.back()]);
        }
        if (count == 3) return addTriangle(0, 1, 2);
        if (count < 3) return void(++mesh.skippedFaces);
        for (const auto& [a, b, c] : triangulate(points)) addTriangle(a, b, c);
    }

    uint takeIndex(const PlyProperty& list, std::uint64_t mark) {
        const double index = values->number(list.type);
        if (!(index >= 0 && index < double(mesh.vertices.size()) && index == std::floor(index)))
            fail(Values::placeOf(mark), fmt::format("a face refers to vertex {}", index),
                 fmt::format("the file has {}, counted from 0", mesh.vertices.size()));
        const auto vertex = static_cast<uint>(index);
        if (!allFinite(mesh.vertices[vertex]))
            fail(Values::placeOf(wrongVertices.at(vertex)), "found a vertex that a face uses, and is not finite",
                 "allowed are three finite numbers");
        return vertex;
    }

    void addTriangle(uint a, uint b, uint c) {
        const auto corner = [&](uint i) {
            return IndexedMesh::Corner{polygon[i], mesh.normals.empty() ? NONE : polygon[i],
                                       mesh.coordinates[0].empty() ? NONE : polygon[i]};
        };
        mesh.triangles.push_back({corner(a), corner(b), corner(c)});
    }

    const std::filesystem::path& file;
    std::string_view whole;
    const PlyHeader& header;
    std::optional<Values> values;
    IndexedMesh mesh;
    std::map<std::size_t, std::uint64_t> wrongVertices; // those that are not finite: where they stand
    std::vector<uint> polygon;                          // of one face
    std::vector<dvec3> points;
};

} // namespace

IndexedMesh readPly(const std::filesystem::path& file, std::string_view bytes) {
    const PlyHeader header = readPlyHeader(file, bytes);
    if (header.format == PlyFormat::ascii) return PlyReader<PlyWords>{file, bytes, header}.read();
    if (header.format == PlyFormat::bigEndian) return PlyReader<PlyBytes<std::endian::big>>{file, bytes, header}.read();
    return PlyReader<PlyBytes<std::endian::little>>{file, bytes, header}.read();
}
} // namespace vkpm
