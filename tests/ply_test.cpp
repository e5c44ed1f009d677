/// PLY files: all formats are one mesh, and what is wrong is refused by its place.
#include "ply_text.h"
#include "scene/mesh.h"
#include "scene_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace vkpm {
namespace {

using testing::HasSubstr;

Mesh loadPly(const std::string& text, Smoothness smoothness = Smoothness::fromFile) {
    return loadMesh(writeScene(text, "mesh.ply"), smoothness);
}

std::string refusalOf(const std::string& text) {
    try {
        loadPly(text);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(Ply, AllFormatsAreOneMesh) {
    for (const std::string& text : {asciiPly(), binaryPly<std::endian::little>(), binaryPly<std::endian::big>()}) {
        const Mesh mesh = loadPly(text);
        ASSERT_EQ(mesh.triangles.size(), 5u); // two, and three of a pentagon
        EXPECT_EQ(mesh.triangles[1].points, (std::array<glm::dvec3, 3>{{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}}));
        EXPECT_EQ(mesh.triangles[4].normals.value()[2], vec3(0, 0, 1));
        EXPECT_FALSE(loadPly(text, Smoothness::flat).triangles[4].normals);
        double area = 0;
        for (const Mesh::Triangle& t : mesh.triangles)
            area += glm::length(glm::cross(t.points[1] - t.points[0], t.points[2] - t.points[0])) / 2;
        EXPECT_NEAR(area, 1 + 2.5, 1e-6);
        EXPECT_THAT(mesh.warnings, testing::ElementsAre(HasSubstr("colours")));
    }
}

// Types, order of properties and elements, line ends, and faces that are none.
TEST(Ply, HeadersOfAllKinds) {
    const std::string text =
        "ply\r\nformat ascii 1.0\r\nelement face 3\r\nproperty list int32 uint8 vertex_index\r\n"
        "element vertex 3\r\nproperty int z\r\nproperty list char float w\r\nproperty float64 y\r\n"
        "property int8 x\r\nend_header\r\n3 0 1 2\r\n2 0 1\r\n0\r\n5 0 6 1\r\n5 2 7 8 6 2\r\n5 0 7 1\r\n";
    for (const std::string& same : {text, replaced(text, "3 0 1 2\r\n", "3 0\n 1 2 ")}) {
        const Mesh mesh = loadPly(same);
        ASSERT_EQ(mesh.triangles.size(), 1u);
        EXPECT_EQ(mesh.triangles[0].points, (std::array<glm::dvec3, 3>{{{1, 6, 5}, {2, 6, 5}, {1, 7, 5}}}));
        EXPECT_FALSE(mesh.triangles[0].normals);
        EXPECT_THAT(mesh.warnings, testing::ElementsAre(HasSubstr("2 faces have fewer than 3 corners")));
    }
}

TEST(Ply, WhatIsWrongHasItsPlace) {
    const std::string ascii = asciiPly(), binary = binaryPly<std::endian::little>();
    const std::size_t end = ascii.size();
    const std::pair<std::string, std::string> wrong[] = {
        {replaced(ascii, "ascii", "utf8"), ".ply:2: found \"utf8 1.0\" as format"},
        {"PLY" + ascii.substr(3), ".ply:1: found \"PLY\"; a PLY file begins with the line \"ply\""},
        {replaced(ascii, "float x", "half x"), ".ply:5: found \"half\" as type"},
        {replaced(ascii, "float x", "float u"), ".ply:4: vertices have no property \"x\""},
        {replaced(ascii, "float y", "float x"), ".ply:6: found the property \"x\" twice"},
        {replaced(ascii, "vertex_indices", "corners"), ".ply:15: faces have no list \"vertex_indices\""},
        {replaced(ascii, "element vertex", "element point"), ".ply:18: the file has no element \"vertex\""},
        {replaced(ascii, "vertex 7", "vertex 4000000000"), ".ply:4: found 4000000000 of the element \"vertex\""},
        {replaced(ascii, "face 3", "face 0"), "the mesh has no faces"},
        {replaced(ascii, "3 0 1 2", "3 0 1 7"), ".ply:28: a face refers to vertex 7; the file has 7, counted from 0"},
        {replaced(ascii, "3 0 1 2", "3 0 1 -1"), ".ply:28: a face refers to vertex -1"},
        {replaced(ascii, "3 0 1 2", "3 0 1 x"), ".ply:28: found \"x\""},
        {replaced(ascii, "1 3 0 1 2", "1 -3 0 1 2"), ".ply:28: found a list of -3 values"},
        {replaced(ascii, "1.000000 0.000000 0.000000", "nan 0 0"), ".ply:20: found a vertex that a face uses"},
        {replaced(ascii, "0 0 1 255", "0 inf 1 255"), ".ply:19: a normal that a face uses is not finite"},
        {ascii.substr(0, end - 4), ".ply:30: the file ends here"},
        {binary.substr(0, binary.size() - 1), fmt::format(": byte {}: the file ends here", binary.size() - 4)},
        {"ply\nformat ascii 1.0\n", ".ply:3: the file ends before its header does"}};
    for (const auto& [text, message] : wrong) EXPECT_THAT(refusalOf(text), HasSubstr(message)) << text.substr(0, 700);
}

} // namespace
} // namespace vkpm
