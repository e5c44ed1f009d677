/// Scene files that no person would write, given to the program: refused by name and place, at once and in little
/// memory.
#include "program.h"
#include "refusal.h"
#include "scene/triangulate.h"
#include "scene_text.h"
#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

namespace vkpm {
namespace {

using glm::dvec3;
using nlohmann::json;
using testing::HasSubstr;

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
constexpr long maxMebibytes = sanitized ? 1500 : 400; // maxSceneBytes and what a parser makes of them
constexpr double maxSeconds = sanitized ? 60 : 10;

struct Measured {
    int code = 0;
    std::string output;
    double seconds = 0;
    long mebibytes = 0; // most resident memory
};

class HostileInput : public Program {
protected:
    Measured refuse(const std::string& file, const fs::path& input = "/dev/null") const {
        const fs::path log = folder / "log.txt";
        const auto start = std::chrono::steady_clock::now();
        const pid_t child = ::fork();
        if (child == 0) {
            const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
            ::dup2(::open(input.c_str(), O_RDONLY), 0);
            ::dup2(output, 2);
            if (::chdir(folder.c_str()) != 0) ::_exit(126);
            ::alarm(120);
            ::execl(VKPM_PROGRAM, VKPM_PROGRAM, "--scene", file.c_str(), nullptr);
            ::_exit(127);
        }
        int status = 0;
        rusage usage{};
        ::wait4(child, &status, 0, &usage);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytesOf(log), seconds, usage.ru_maxrss / 1024};
    }

    /// Gives the program a scene and expects it to refuse a file, that one or a mesh of it.
    void expectRefusal(const std::string& scene, const std::string& message, std::string file = "") const {
        const Measured result = refuse(scene);
        if (file.empty()) file = scene;
        EXPECT_EQ(result.code, 2) << file;
        EXPECT_THAT(result.output, HasSubstr("vkpm: " + file + message)) << file;
        EXPECT_EQ(faultOfRefusal(result.output.substr(0, result.output.size() - 1), "vkpm: "), "") << file;
        EXPECT_LT(result.seconds, maxSeconds) << file;
        EXPECT_LT(result.mebibytes, maxMebibytes) << file;
    }

    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
        return folder / name;
    }
    static json withMesh(const std::string& file) {
        json scene = smallScene();
        scene["shapes"].push_back({{"type", "mesh"}, {"file", file}, {"material", "grey"}});
        return scene;
    }
    void expectMeshRefusal(const std::string& mesh, const std::string& message) const {
        write("scene.json", withMesh(mesh).dump());
        expectRefusal("scene.json", message, message.starts_with(": /") ? "scene.json" : mesh);
    }
};

const char* const triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(HostileInput, FilesOfNoBytesAndOfTwoGibibytes) {
    for (const char* name : {"empty.json", "empty.obj"}) write(name, "");
    expectRefusal("empty.json", ":1:1: the file is empty");
    expectMeshRefusal("empty.obj", ":1: the mesh has no faces");
    for (const char* name : {"big.json", "big.obj"}) {
        write(name, "");
        fs::resize_file(folder / name, 2ull << 30);
    }
    expectRefusal("big.json", ":1: the file has more than 64 MiB");
    expectMeshRefusal("big.obj", ":1: the file has more than 1024 MiB");
    write("holes.obj", triangle);
    fs::resize_file(folder / "holes.obj", 1ull << 30);
    expectMeshRefusal("holes.obj", ":5: found a byte 0");
    for (const char* name : {"big.ply", "big.glb"}) {
        write(name, "");
        fs::resize_file(folder / name, 2ull << 30);
    }
    expectRefusal("big.glb", ":1: the file has more than 1024 MiB");
    write("numbers.json", "{\"shapes\": [" + std::string(30 << 20, '1') + "]}");
    expectRefusal("numbers.json", ":1:31457292: number overflow");
}

TEST_F(HostileInput, FilesThatDoNotEndOrAreNoFiles) {
    expectRefusal("/dev/zero", ":1: found a byte 0");
    expectMeshRefusal("/dev/zero", ": /shapes/2/file: /dev/zero: this is a device");
    ::mkfifo((folder / "pipe.obj").c_str(), 0666);
    expectMeshRefusal("pipe.obj", ": /shapes/2/file: pipe.obj: this is a device or a pipe");
    fs::create_symlink("b.obj", folder / "a.obj");
    fs::create_symlink("a.obj", folder / "b.obj");
    expectMeshRefusal("a.obj", ": /shapes/2/file: a.obj: the file cannot be found (Too many levels of symbolic links)");
    expectMeshRefusal(std::string(5000, 'x'), ": /shapes/2/file: ");
    // A pipe that ends is as good as a file.
    const fs::path text = write("piped.json", R"({"camera": 1})");
    EXPECT_THAT(refuse("/dev/stdin", text).output, HasSubstr("/dev/stdin: /: the key \"shapes\" is missing"));
}

// Scenes do not include each other: a key that tries is unknown, and a mesh that is the scene has no faces.
TEST_F(HostileInput, PathsThatLeaveTheFolderAndCycles) {
    fs::create_directory(folder / "inner");
    write("outer.obj", triangle);
    write("inner/scene.json", withMesh("../outer.obj").dump());
    EXPECT_NO_THROW(loadScene(folder / "inner/scene.json")); // meshes may lie anywhere
    expectMeshRefusal("../../../../../../../../etc/passwd", ":");
    write("scene.json", withMesh("scene.json").dump());
    expectRefusal("scene.json", ": /: the key \"asset\" is missing"); // read as glTF
    json importing = smallScene();
    importing["import"] = "scene.json";
    write("scene.json", importing.dump());
    expectRefusal("scene.json", ": /import: found \"scene.json\"; allowed is a .gltf or .glb file");
    json scene = smallScene();
    scene["include"] = "scene.json";
    write("scene.json", scene.dump());
    expectRefusal("scene.json", ": /include: unknown key \"include\"");
}

TEST_F(HostileInput, LineEndsAndMarks) {
    const std::string crlf = "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
                      cr = "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r";
    for (const std::string& text : {crlf, cr, "\xEF\xBB\xBF" + std::string(triangle)}) {
        write("mesh.obj", text);
        write("scene.json", "\xEF\xBB\xBF" + withMesh("mesh.obj").dump(1));
        EXPECT_EQ(loadScene(folder / "scene.json").triangleCount, 3u);
    }
    write("mesh.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 7 8 9\r");
    expectMeshRefusal("mesh.obj", ":4: a face refers to vertex 7");
    write("mesh.obj", std::string(triangle) + "v 1 \x1b[31m 0\n");
    expectMeshRefusal("mesh.obj", R"(:5: found "\x1b[31m" as a coordinate)");
    write("wide.json", std::string("\xFF\xFE{\0}\0", 6));
    expectRefusal("wide.json", ":1: found a byte 0");
}

TEST_F(HostileInput, NumbersAndDepth) {
    for (const char* number : {"NaN", "Infinity", "1e400", "-1e400", "0x1", "1e39", "-1"}) {
        write(
            "scene.json",
            R"({"camera": {"origin": [0, 0, 3], "target": [0, 0, 0]}, "shapes": [{"type": "sphere", "center": [0, 0, 0], "emission": 1, "radius": )" +
                std::string(number) + "}]}");
        const Measured result = refuse("scene.json");
        EXPECT_EQ(result.code, 2) << number;
        EXPECT_EQ(faultOfRefusal(result.output.substr(0, result.output.size() - 1), "vkpm: "), "") << number;
        if (number[0] == 'N' || number[0] == '1' || number[0] == 'I') {
            EXPECT_THAT(result.output, testing::ContainsRegex("scene.json(:1:1[0-9]+|: /shapes/0/radius): ")) << number;
        }
    }
    for (const char* bracket : {"[", "{\"a\": "}) {
        std::string deep = "{\"shapes\": ";
        for (int i = 0; i < 100'000; i++) deep += bracket;
        write("deep.json", deep);
        expectRefusal("deep.json", ": /shapes/");
    }
}

// A name a mebibyte long does not make a message of a mebibyte.
TEST_F(HostileInput, MessagesStayShort) {
    json scene = smallScene();
    const std::string name(1 << 20, 'n');
    scene["materials"][name] = {{"type", "diffuse"}, {"albedo", name}};
    write("scene.json", scene.dump());
    expectRefusal("scene.json", ": /materials/nnnn");
    scene = smallScene();
    for (int i = 0; i < 10'000; i++) scene["materials"]["material " + std::to_string(i)] = scene["materials"]["grey"];
    scene["shapes"][0]["material"] = "gray";
    write("scene.json", scene.dump());
    expectRefusal("scene.json", ": /shapes/0/material: unknown material \"gray\"; did you mean \"grey\"? known: ");
}

TEST_F(HostileInput, NoMemoryOnTheHostIsSaid) {
    if (sanitized) GTEST_SKIP() << "sanitizers reserve more than any limit";
    std::string text;
    for (int i = 0; i < 4'000'000; i++) text += "v 0 0 0\n";
    write("mesh.obj", text);
    write("scene.json", withMesh("mesh.obj").dump());
    const int status = std::system(
        fmt::format("cd {} && ulimit -v 150000 && {} --scene scene.json > log.txt 2>&1", folder.string(), VKPM_PROGRAM)
            .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_THAT(bytesOf(folder / "log.txt"), HasSubstr("vkpm: out of memory on this machine"));
}

double areaOf(const std::vector<dvec3>& polygon, const std::vector<std::array<uint, 3>>& triangles, bool signedly) {
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
        const double z = glm::cross(polygon[b] - polygon[a], polygon[c] - polygon[a]).z;
        sum += signedly ? z / 2 : std::abs(z) / 2;
    }
    return sum;
}

// Triangles cover a polygon once if their areas add up to that of the polygon both with and without signs.
TEST(Triangulate, CoversPolygonsOnce) {
    const std::vector<std::vector<dvec3>> polygons{
        {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},     // a rectangle
        {{0, 0, 0}, {4, 0, 0}, {0.5, 0.5, 0}, {0, 4, 0}}, // a dart: one diagonal is outside
        {{4, 0, 0}, {0.5, 0.5, 0}, {0, 4, 0}, {0, 0, 0}}, // from another corner
        {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, // a U
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}},                       // corners in a line
        {{0, 0, 0},
         {5, 0, 0},
         {5, 5, 0},
         {1, 5, 0},
         {1, 2, 0},
         {3, 2, 0},
         {3, 3, 0},
         {2, 3, 0},
         {2, 4, 0},
         {4, 4, 0},
         {4, 1, 0},
         {0, 1, 0}}}; // a spiral
    for (std::size_t i = 0; i < polygons.size(); i++) {
        const auto triangles = triangulate(polygons[i]);
        double area = 0; // by the shoelace formula
        for (std::size_t k = 0; k < polygons[i].size(); k++)
            area += glm::cross(polygons[i][k], polygons[i][(k + 1) % polygons[i].size()]).z / 2;
        EXPECT_EQ(triangles.size(), polygons[i].size() - 2) << i;
        EXPECT_NEAR(areaOf(polygons[i], triangles, true), area, 1e-6) << i;
        EXPECT_NEAR(areaOf(polygons[i], triangles, false), area, 1e-6) << i;
        std::vector<dvec3> reversed(polygons[i].rbegin(), polygons[i].rend());
        EXPECT_NEAR(areaOf(reversed, triangulate(reversed), true), -area, 1e-6) << i;
        EXPECT_NEAR(areaOf(reversed, triangulate(reversed), false), area, 1e-6) << i;
    }
    // What is no polygon at all still gives triangles, two fewer than corners.
    EXPECT_EQ(triangulate(std::vector<dvec3>(100, dvec3{1, 2, 3})).size(), 98u);
    EXPECT_EQ(triangulate(std::vector<dvec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0.5, 0}}).size(), 3u);
}

} // namespace
} // namespace vkpm
