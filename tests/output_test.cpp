/// What is written: images, statistics, and files that are whole or not there.
#include "output/atomic_file.h"
#include "output/exr.h"
#include "output/film_image.h"
#include "output/png.h"
#include "output/statistics.h"
#include "scene/scene.h"
#include "shared_layers.h"
#include <algorithm>
#include <bit>
#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stb_image.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vkpm {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <class Error, class Action> std::string messageOf(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

class OutputTest : public testing::Test {
protected:
    OutputTest() { fs::create_directories(folder); }
    ~OutputTest() override { fs::remove_all(folder); }

    std::ptrdiff_t fileCount() const { return std::distance(fs::directory_iterator(folder), {}); }

    const fs::path folder = fs::temp_directory_path() / fmt::format("vkpm_output_test.{}", ::getpid());
};

/// Lets files grow to `bytes` at most, as a full disk does, until the end of its life.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before);
        const rlimit limit{bytes, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
    }

private:
    rlimit before{};
    void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

/// An image whose values are all bit patterns that a careless conversion would lose.
Image oddImage() {
    const std::vector<uint> bits{0x00000000, 0x80000000, 0x00000001, 0x7f7fffff, 0x3f800001, 0xbf7fffff,
                                 0x7f800000, 0xff800000, 0x7fc00123, 0x33333333, 0x477fe001, 0x38800001};
    Image image{.size = {4, 3}, .channels = {{"R", {}}, {"direct.G", {}}, {"depth.Z", {}}}, .attributes = {}};
    for (uint c = 0; c < 3; ++c)
        for (uint i = 0; i < 12; ++i) image.channels[c].values.push_back(std::bit_cast<float>(bits[(i + 5 * c) % 12]));
    image.attributes = {{"scene", "{\n  \"name\": \"caf\u00e9\"\n}"},
                        {"empty", ""},
                        {"an attribute with a name of more than thirty-one characters", "x"}};
    return image;
}

TEST_F(OutputTest, ExrKeepsEveryBit) {
    const Image image = oddImage();
    writeExr(folder / "a.exr", image);
    const Image read = readExr(folder / "a.exr");
    EXPECT_EQ(read.size, image.size);
    EXPECT_EQ(read.attributes, image.attributes);
    ASSERT_EQ(read.channels.size(), image.channels.size());
    for (const Channel& channel : image.channels) {
        const auto same = [&](const Channel& other) { return other.name == channel.name; };
        const auto other = std::find_if(read.channels.begin(), read.channels.end(), same);
        ASSERT_NE(other, read.channels.end()) << channel.name;
        for (size_t i = 0; i < channel.values.size(); ++i)
            EXPECT_EQ(std::bit_cast<uint>(other->values[i]), std::bit_cast<uint>(channel.values[i])) << i;
    }
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(OutputTest, ExrIsTheSameFileEveryTime) {
    writeExr(folder / "a.exr", oddImage());
    writeExr(folder / "b.exr", oddImage());
    EXPECT_EQ(contentOf(folder / "a.exr"), contentOf(folder / "b.exr"));
}

TEST_F(OutputTest, ReadingRefusesWhatIsNoExr) {
    const fs::path path = folder / "a.exr";
    const auto read = [&] { readExr(path); };
    EXPECT_THAT(messageOf<InputError>(read), AllOf(HasSubstr("a.exr"), HasSubstr("No such file")));
    std::ofstream(path) << "P6 1 1 255 ...";
    EXPECT_THAT(messageOf<InputError>(read), AllOf(HasSubstr("a.exr"), HasSubstr("not an EXR file")));
    writeExr(path, oddImage());
    fs::resize_file(path, fs::file_size(path) - 20);
    EXPECT_THAT(messageOf<InputError>(read), HasSubstr("a.exr"));
    fs::resize_file(path, 40);
    EXPECT_THAT(messageOf<InputError>(read), HasSubstr("a.exr"));
    EXPECT_THAT(messageOf<InputError>([&] { readExr(folder); }), HasSubstr("folder"));
}

/// The value of a channel at a pixel.
float valueAt(const Image& image, const std::string& name, size_t pixel) {
    for (const Channel& channel : image.channels)
        if (channel.name == name) return channel.values.at(pixel);
    ADD_FAILURE() << "no channel " << name;
    return -1;
}

std::vector<Pixel> somePixels() {
    std::vector<Pixel> pixels(6);
    for (uint i = 0; i < 6; ++i) {
        Sample& mean = pixels[i].mean;
        for (uint layer = 0; layer < LAYER_COUNT; ++layer)
            mean.layers[layer] = vec3(0.1f, 1.7f, 0.01f) * float(1 + layer * layer + 10 * i);
        mean.albedo = vec3(0.25f, 0.5f, 0.75f);
        mean.normal = vec3(-1, 0.5f, 0.125f);
        mean.depth = 3.0f * float(i);
        mean.covered = i == 0 ? 0.0f : 0.5f;
        pixels[i].noise = vec3(0.5f, 24, 2) * float(i);
    }
    return pixels;
}

TEST_F(OutputTest, FilmHasTheLayersAndBeautyIsTheirSum) {
    const std::vector<Pixel> pixels = somePixels();
    const Image image = filmImage(pixels, {3, 2}, allLayers);
    EXPECT_EQ(image.size, uvec2(3, 2));
    EXPECT_EQ(image.channels.size(), 31u);
    for (size_t i = 0; i < pixels.size(); ++i)
        for (uint c = 0; c < 3; ++c) {
            const std::string letter(1, "RGB"[c]);
            float sum = 0;
            uint index = 0;
            for (const char* layer : {"emission.", "direct.", "specular.", "caustic.", "indirect."}) {
                EXPECT_EQ(valueAt(image, layer + letter, i), pixels[i].mean.layers[index++][c]) << layer;
                sum += valueAt(image, layer + letter, i);
            }
            EXPECT_EQ(valueAt(image, letter, i), sum);
        }
    EXPECT_EQ(valueAt(image, "albedo.G", 1), 0.5f);
    EXPECT_EQ(valueAt(image, "normal.X", 1), -1.0f);
    EXPECT_EQ(valueAt(image, "normal.Z", 1), 0.125f);
    EXPECT_EQ(valueAt(image, "depth.Z", 0), 0.0f);
    EXPECT_EQ(valueAt(image, "depth.Z", 2), 12.0f);
}

TEST_F(OutputTest, FilmHasNoLayersThatNobodyAskedFor) {
    const Image image = filmImage(somePixels(), {3, 2}, 1u << LAYER_CAUSTIC | 1u << ASK_DEPTH);
    std::vector<std::string> names;
    for (const Channel& channel : image.channels) names.push_back(channel.name);
    EXPECT_THAT(names, ElementsAre("R", "G", "B", "caustic.R", "caustic.G", "caustic.B", "depth.Z"));
}

TEST_F(OutputTest, DevelopedIsSrgbUnderAnExposure) {
    std::vector<Pixel> pixels(4, Pixel{});
    pixels[1].mean.layers[LAYER_DIRECT] = vec3(0.25f, 1, 9);
    pixels[1].mean.layers[LAYER_INDIRECT] = vec3(0.25f, 0, 0);
    pixels[2].mean.layers[LAYER_DIRECT] = vec3(0.001f, -1, 0.0031308f);
    pixels[3].mean.layers[LAYER_DIRECT] = vec3(0.25f);
    EXPECT_THAT(develop(pixels, 0), ElementsAre(0xff000000u, 0xffffffbcu, 0xff0a0003u, 0xff898989u));
    EXPECT_EQ(develop(pixels, 1)[3], 0xffbcbcbcu);
}

TEST_F(OutputTest, PngCanBeReadBack) {
    const std::vector<uint> pixels{0xff0000ff, 0xff00ff00, 0xffff0000, 0x00102030, 0xffffffff, 0xff000000};
    writePng(folder / "a.png", {3, 2}, pixels);
    int width = 0, height = 0, channels = 0;
    unsigned char* read = stbi_load((folder / "a.png").c_str(), &width, &height, &channels, 3);
    ASSERT_NE(read, nullptr);
    EXPECT_THAT((std::vector{width, height, channels}), ElementsAre(3, 2, 3));
    for (size_t i = 0; i < pixels.size(); ++i)
        EXPECT_EQ(read[3 * i] | read[3 * i + 1] << 8 | read[3 * i + 2] << 16, pixels[i] & 0xffffff) << i;
    std::free(read);
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(OutputTest, AFullDiskLeavesTheOldFile) {
    const fs::path path = folder / "a.exr";
    replaceFile(path, std::string_view("old"));
    const std::string large(100'000, 'x');
    std::string message;
    {
        const FileSizeLimit limit(5'000);
        message = messageOf<std::runtime_error>([&] { replaceFile(path, large); });
    }
    EXPECT_THAT(message, HasSubstr("a.exr: write: File too large; raise the limit"));
    EXPECT_EQ(contentOf(path), "old");
    EXPECT_EQ(fileCount(), 1);
    replaceFile(path, large);
    EXPECT_EQ(contentOf(path), large);
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(OutputTest, AFullDeviceSaysSo) {
    EXPECT_THAT(messageOf<std::runtime_error>([] { replaceFile("/dev/full", std::string_view("x")); }),
                AllOf(HasSubstr("/dev/full"), HasSubstr("write"), HasSubstr("No space left"), HasSubstr("free some")));
    EXPECT_FALSE(fs::is_regular_file("/dev/full"));
}

TEST_F(OutputTest, AFolderThatCannotBeWrittenIsNamed) {
    const auto write = [](const fs::path& path) { return [=] { replaceFile(path, std::string_view("x")); }; };
    EXPECT_THAT(messageOf<std::runtime_error>(write(folder / "none" / "a.exr")),
                AllOf(HasSubstr("none/a.exr"), HasSubstr("open"), HasSubstr("No such file"), HasSubstr("create")));
    EXPECT_THAT(messageOf<std::runtime_error>(write(folder)), AllOf(HasSubstr("Is a directory"), HasSubstr("name")));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { requireWritable(folder / "none" / "a.exr"); }), HasSubstr("open"));
    if (::geteuid() == 0) return;
    fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(messageOf<std::runtime_error>(write(folder / "a.exr")), HasSubstr("Permission denied"));
    fs::permissions(folder, fs::perms::owner_all);
}

TEST_F(OutputTest, AskingWhetherAFileCanBeWrittenChangesNothing) {
    requireWritable(folder / "a.exr");
    EXPECT_EQ(fileCount(), 0);
    replaceFile(folder / "a.exr", std::string_view("old"));
    requireWritable(folder / "a.exr");
    EXPECT_EQ(contentOf(folder / "a.exr"), "old");
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(OutputTest, ALinkStaysALink) {
    replaceFile(folder / "real", std::string_view("old"));
    fs::create_symlink("real", folder / "link");
    replaceFile(folder / "link", std::string_view("new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(contentOf(folder / "real"), "new");
}

TEST_F(OutputTest, StatisticsHaveTheContractsKeys) {
    Statistics statistics;
    statistics.device = "a device \xff"; // not UTF-8
    statistics.rays = 0xffffffffffffull;
    statistics.stages = {{"trace", 1.5}, {"film", 0.25}, {"trace", 0.5}};
    statistics.buffers = {{"photons", 5'000'000'000}};
    statistics.caustic.stored = 7;
    statistics.features.stackSize = 17;
    statistics.leftOut = {"caustic map"};
    writeStatistics(folder / "s.json", statistics);
    const auto json = nlohmann::json::parse(contentOf(folder / "s.json"));
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    ASSERT_THAT(keys,
                ElementsAre("device", "dispatches", "error", "features", "left_out", "memory", "needed", "nonfinite",
                            "passes", "photons", "radius", "rays", "seconds", "seed", "stages", "waits", "warnings"));
    for (const char* key : {"total", "setup", "render"}) EXPECT_TRUE(json["seconds"][key].is_number()) << key;
    for (const char* map : {"global", "caustic"})
        for (const char* key : {"emitted", "stored", "absorbed", "escaped", "lost"})
            EXPECT_TRUE(json["photons"][map][key].is_number_unsigned()) << map << key;
    EXPECT_EQ(json["photons"]["caustic"]["stored"], 7);
    EXPECT_EQ(json["rays"], 0xffffffffffffull);
    EXPECT_EQ(json["stages"]["trace"], 2.0);
    EXPECT_EQ(json["memory"]["buffers"]["photons"], 5'000'000'000);
    EXPECT_EQ(json["memory"]["device_bytes"], 0);
    EXPECT_EQ(json["features"]["stackSize"], 17);
    std::set<std::string> names{
#define X(id, type, name, value) #name,
        FEATURES(X)
#undef X
#define X(id, NAME, name, lobes, words) "has" #name,
            MATERIALS(X)
#undef X
#define X(id, NAME, name, words) "has" #name "Lights",
                LIGHTS(X)
#undef X
    };
    names.erase("materialKinds"); // each kind by its name
    names.erase("lightKinds");
    EXPECT_EQ(json["features"].size(), names.size());
    for (const std::string& name : names) EXPECT_TRUE(json["features"][name].is_number_unsigned()) << name;
    EXPECT_EQ(json["left_out"][0], "caustic map");
}

} // namespace
} // namespace vkpm
