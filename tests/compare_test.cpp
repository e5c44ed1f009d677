/// Error measures against values worked out by hand, the layers of an image, and vkpm compare on files.
#include "measure/layer_error.h"
#include "output/exr.h"
#include "program.h"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace vkpm {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr float INFINITE = std::numeric_limits<float>::infinity();
constexpr float NOT = std::numeric_limits<float>::quiet_NaN();

Layer colour(const Image& image) { return imageLayers(image).at(0); }

/// An image of three pixels in a row.
Image row(std::vector<float> red, std::vector<float> green, std::vector<float> blue) {
    return {.size = {3, 1}, .channels = {{"R", std::move(red)}, {"G", std::move(green)}, {"B", std::move(blue)}}};
}

TEST(Compare, MeasuresAreTheirFormulas) {
    const Image image = row({1, 2, 0}, {0.5f, 0, 4}, {0, 0, 1});
    const Image reference = row({2, 2, 0}, {0, 0, 1}, {0, -1, 1});
    const LayerError error = measureLayer(colour(image), colour(reference));
    EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((1 + 0.25 + 9 + 1) / 9));
    EXPECT_DOUBLE_EQ(error.relmse, (1 / 4.01 + 0.25 / 0.01 + 9 / 1.01 + 1 / 1.01) / 9);
    EXPECT_DOUBLE_EQ(error.meanError, (-1 + 0.5 + 3 + 1) / 9);
    EXPECT_DOUBLE_EQ(error.meanRelativeError, (1 / 2.01 + 0.5 / 0.01 + 3 / 1.01 + 1 / 1.01) / 9);
    EXPECT_EQ(error.maxError, 3);
    EXPECT_EQ(error.nonfinite, 0u);
    EXPECT_TRUE(error.flip > 0 && error.flip < 1) << error.flip;
}

TEST(Compare, SumsKeepSmallErrorsBesideLargeOnes) {
    const size_t count = 1 << 20;
    Image image{.size = {1024, 1024}, .channels = {{"depth.Z", std::vector<float>(count, 0x1p-20f)}}};
    const Image reference{.size = {1024, 1024}, .channels = {{"depth.Z", std::vector<float>(count, 0)}}};
    image.channels[0].values[0] = 1;
    const LayerError error = measureLayer(colour(image), colour(reference));
    EXPECT_NEAR(error.meanError * double(count), 2 - 0x1p-20, 1e-12);
    EXPECT_NEAR(error.rmse * error.rmse * double(count), 1 + (double(count) - 1) * 0x1p-40, 1e-12);
    EXPECT_EQ(error.maxError, 1);
    EXPECT_TRUE(std::isnan(error.flip));
}

TEST(Compare, LeavesOutPixelsThatAreNotFinite) {
    const Image image = row({1, NOT, 7}, {1, 100, 7}, {1, 100, 7});
    const Image reference = row({2, 0, 0}, {1, 0, -INFINITE}, {1, 0, 0});
    const LayerError error = measureLayer(colour(image), colour(reference));
    EXPECT_EQ(error.nonfinite, 2u);
    EXPECT_DOUBLE_EQ(error.rmse, std::sqrt(1.0 / 3));
    EXPECT_DOUBLE_EQ(error.meanError, -1.0 / 3);
    EXPECT_EQ(error.maxError, 1);
    EXPECT_TRUE(error.flip > 0 && error.flip < 1) << error.flip;
}

TEST(Compare, SaysNothingOfAnImageThatIsNowhereFinite) {
    const Image image = row({NOT, NOT, NOT}, {0, 0, 0}, {0, 0, 0});
    const LayerError error = measureLayer(colour(image), colour(image));
    EXPECT_EQ(error.nonfinite, 3u);
    for (const double value :
         {error.rmse, error.relmse, error.meanError, error.meanRelativeError, error.maxError, error.flip})
        EXPECT_TRUE(std::isnan(value));
}

/// An image of one pixel with these channels.
Image pixel(const std::vector<std::string>& channels) {
    Image image{.size = {1, 1}};
    for (const std::string& name : channels)
        image.channels.push_back({name, {static_cast<float>(image.channels.size())}});
    return image;
}

TEST(Compare, LayersAreTriplesAndSingleChannels) {
    const Image image = pixel({"A",        "B",        "G",        "R",        "a.b.B",           "a.b.G",
                               "a.b.R",    "a.b.X",    "a.b.Y",    "a.b.Z",    "depth.Z",         "direct.G",
                               "direct.R", "normal.X", "normal.Y", "normal.Z", "state0.direct.R", "state12.fine.R",
                               "state.R",  "state7",   "states.R"});
    std::vector<std::string> names;
    for (const Layer& layer : imageLayers(image)) names.push_back(layer.name);
    EXPECT_THAT(names, ElementsAre("A", "beauty", "a.b", "a.b.X", "a.b.Y", "a.b.Z", "depth.Z", "direct.G", "direct.R",
                                   "normal", "state.R", "state7", "states.R"));
    const Layer beauty = imageLayers(image)[1], normal = imageLayers(image)[9];
    EXPECT_TRUE(beauty.isColour && !normal.isColour);
    EXPECT_THAT((std::vector{beauty.channels[0][0], beauty.channels[1][0], beauty.channels[2][0]}),
                ElementsAre(3, 2, 1));
    EXPECT_EQ(normal.channels.size(), 3u);
}

class CompareFiles : public Program {
protected:
    void write(const std::string& name, const Image& image) const { writeExr(folder / name, image); }
};

TEST_F(CompareFiles, JsonHasAllMeasuresByLayer) {
    Image image = row({1, 2, NOT}, {1, 1, 1}, {0, 0, 0}), reference = row({1, 1, 1}, {1, 1, 1}, {0, 0, 0});
    image.channels.push_back({"noise.R", {1, 1, 1}});
    reference.channels.push_back({"depth.Z", {1, 2, 3}});
    for (Image* each : {&image, &reference})
        for (const char* name : {"void.X", "void.Y", "void.Z", "state0.direct.R"})
            each->channels.push_back({name, {INFINITE, NOT, INFINITE}});
    write("a.exr", image);
    write("b.exr", reference);
    const Result result = run("compare a.exr b.exr --json");
    ASSERT_EQ(result.code, 0) << result.output;
    const auto json = nlohmann::ordered_json::parse(result.output);
    EXPECT_EQ(json["layers"].size(), 2u);
    EXPECT_EQ(json["only_in_image"], (std::vector<std::string>{"noise.R"}));
    EXPECT_EQ(json["only_in_reference"], (std::vector<std::string>{"depth.Z"}));
    EXPECT_EQ(json["size"], (std::vector{3, 1}));
    const auto& beauty = json["layers"]["beauty"];
    std::vector<std::string> keys;
    for (const auto& [key, value] : beauty.items()) keys.push_back(key);
    EXPECT_THAT(keys, ElementsAre("rmse", "relmse", "error", "mean_error", "mean_relative_error", "max_error", "flip",
                                  "nonfinite"));
    EXPECT_DOUBLE_EQ(beauty["rmse"], std::sqrt(1.0 / 6));
    EXPECT_DOUBLE_EQ(beauty["mean_error"], 1.0 / 6);
    EXPECT_TRUE(beauty["flip"].is_number());
    EXPECT_EQ(beauty["nonfinite"], 1);
    EXPECT_TRUE(json["layers"]["void"]["rmse"].is_null() && json["layers"]["void"]["flip"].is_null());
    EXPECT_EQ(json["layers"]["void"]["nonfinite"], 3);
}

TEST_F(CompareFiles, TheTableHasALineForEachLayer) {
    Image image = row({1, 2, 3}, {1, 1, 1}, {0, 0, 0});
    image.channels.push_back({"depth.Z", {1, 2, 3}});
    write("a.exr", image);
    const Result result = run("compare a.exr a.exr");
    EXPECT_EQ(result.code, 0);
    EXPECT_THAT(result.output,
                AllOf(HasSubstr("\nbeauty"), HasSubstr("\ndepth.Z"), HasSubstr("mean(x - r)"), Not(HasSubstr("nan"))));
    EXPECT_THAT(result.output, Not(HasSubstr("Only in")));
}

/// A part of an EXR file: channels with one value each, in a data window.
struct Part {
    std::string name;
    Imath::Box2i window;
    std::vector<std::pair<std::string, float>> channels;
};

/// Writes a file as other programs do: several parts, windows of their own.
void writeParts(const std::filesystem::path& path, Imath::Box2i display, const std::vector<Part>& parts) {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) {
        Imf::Header& header = headers.emplace_back(display, part.window);
        header.setName(part.name);
        header.setType(Imf::SCANLINEIMAGE);
        for (const auto& [name, value] : part.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
    for (std::size_t i = 0; i < parts.size(); i++) {
        const Imath::Box2i& window = parts[i].window;
        const auto width = std::size_t(window.max.x - window.min.x + 1);
        std::vector<std::vector<float>> values;
        values.reserve(parts[i].channels.size());
        Imf::FrameBuffer buffer;
        for (const auto& [name, value] : parts[i].channels) {
            std::vector<float>& plane = values.emplace_back(width * std::size_t(window.max.y - window.min.y + 1));
            for (std::size_t p = 0; p < plane.size(); p++) // a function of the place in the picture
                plane[p] = value + float(window.min.x - display.min.x + int(p % width)) +
                           100 * float(window.min.y - display.min.y + int(p / width));
            buffer.insert(name,
                          Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float), sizeof(float) * width));
        }
        Imf::OutputPart output(file, int(i));
        output.setFrameBuffer(buffer);
        output.writePixels(window.max.y - window.min.y + 1);
    }
}

Imath::Box2i box(int left, int top, int right, int bottom) { return {{left, top}, {right, bottom}}; }
const std::vector<std::pair<std::string, float>> RGB{{"R", 1.0f}, {"G", 2.0f}, {"B", 3.0f}};

// Pictures are compared where they lie, whatever their data windows and the corner of the display window.
TEST_F(CompareFiles, WindowsAreHeeded) {
    writeParts(folder / "whole.exr", box(0, 0, 39, 29), {{"", box(0, 0, 39, 29), RGB}});
    writeParts(folder / "elsewhere.exr", box(-7, 1000, 32, 1029), {{"", box(-7, 1000, 32, 1029), RGB}});
    writeParts(folder / "overscan.exr", box(0, 0, 39, 29), {{"", box(-3, -2, 45, 31), RGB}});
    writeParts(folder / "crop.exr", box(5, 5, 44, 34), {{"", box(15, 8, 30, 20), RGB}});
    for (const auto& [name, width, height] : {std::tuple("elsewhere", 40, 30), {"overscan", 40, 30}, {"crop", 16, 13}})
        for (const bool swapped : {false, true}) {
            const std::string files =
                swapped ? fmt::format("{}.exr whole.exr", name) : fmt::format("whole.exr {}.exr", name);
            const Result result = run("compare --json " + files);
            ASSERT_EQ(result.code, 0) << result.output;
            const auto json = nlohmann::json::parse(result.output);
            EXPECT_EQ(json["layers"]["beauty"]["max_error"], 0) << files;
            EXPECT_EQ(json["size"], (std::vector{width, height})) << files;
            EXPECT_EQ(json.contains("region"), std::string(name) == "crop");
        }
    EXPECT_THAT(run("compare whole.exr crop.exr").output,
                HasSubstr("Compared where both have values: 16x13 pixels from 10,3 on, of 40x30"));

    writeParts(folder / "other.exr", box(0, 0, 39, 29), {{"", box(0, 0, 9, 29), RGB}});
    writeParts(folder / "shifted.exr", box(0, 0, 95, 79), {{"", box(16, 8, 55, 37), RGB}});
    const Result apart = run("compare other.exr crop.exr"), sizes = run("compare whole.exr shifted.exr");
    EXPECT_EQ(apart.code, 2);
    EXPECT_THAT(apart.output, AllOf(HasSubstr("0,0 to 9,29"), HasSubstr("10,3 to 25,15")));
    EXPECT_EQ(sizes.code, 2);
    EXPECT_THAT(sizes.output, AllOf(HasSubstr("40x30"), HasSubstr("96x80"), HasSubstr("display window")));
}

TEST_F(CompareFiles, PicturesOfOtherProgramsAreFound) {
    const Imath::Box2i all = box(0, 0, 15, 11);
    writeParts(folder / "ours.exr", all,
               {{"",
                 all,
                 {{"R", 1.0f}, {"G", 2.0f}, {"B", 3.0f}, {"albedo.R", 4.0f}, {"albedo.G", 5.0f}, {"albedo.B", 6.0f}}}});
    const auto with = [](const std::string& prefix, std::array<std::string, 3> letters, float first) {
        std::vector<std::pair<std::string, float>> channels;
        for (std::size_t i = 0; i < 3; i++) channels.emplace_back(prefix + letters[i], first + float(i));
        return channels;
    };
    const auto both =
        [](std::vector<std::pair<std::string, float>> a, const std::vector<std::pair<std::string, float>>& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    const std::array<std::string, 3> big{"R", "G", "B"}, small{"r", "g", "b"}, words{"red", "green", "blue"};
    const std::pair<const char*, std::vector<Part>> files[] = {
        {"Blender", {{"", all, both(with("ViewLayer.Combined.", big, 1), with("ViewLayer.DiffDir.", big, 7))}}},
        {"V-Ray", {{"", all, both(with("", words, 1), with("diffuse.", words, 7))}}},
        {"V-Ray, named", {{"", all, both(with("effectsResult.", words, 9), with("RGB_color.", words, 1))}}},
        {"Mitsuba, a nested integrator",
         {{"", all, both(with("image.", big, 1), {{"nn.X", 0.0f}, {"nn.Y", 0.0f}, {"nn.Z", 0.0f}})}}},
        {"one colour", {{"", all, with("myrender.", small, 1)}}},
        {"beauty in a later part", {{"albedo", all, with("albedo.", big, 4)}, {"beauty", all, with("", big, 1)}}},
        {"parts that repeat their names", {{"rgba", all, with("rgba.", big, 1)}, {"depth", all, {{"depth.Z", 1.0f}}}}}};
    for (const auto& [name, parts] : files) {
        writeParts(folder / "theirs.exr", all, parts);
        for (const char* order : {"ours.exr theirs.exr", "theirs.exr ours.exr"}) {
            const Result result = run(std::string("compare --json ") + order);
            ASSERT_EQ(result.code, 0) << name << result.output;
            EXPECT_EQ(nlohmann::json::parse(result.output)["layers"]["beauty"]["max_error"], 0)
                << name << result.output;
        }
    }
    EXPECT_EQ(nlohmann::json::parse(run("compare --json theirs.exr ours.exr").output)["named_in_image"]["R"], "rgba.R");

    // Two colours, neither of which is known to be the picture: said, with what was found.
    writeParts(folder / "theirs.exr", all, {{"", all, both(with("one.", big, 1), with("two.", big, 1))}});
    const Result unknown = run("compare theirs.exr ours.exr");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.output,
                AllOf(HasSubstr("found one, two here and beauty, albedo there"), HasSubstr("Combined")));
    // A reference that does not cover the picture is refused by its windows.
    writeParts(folder / "crop.exr", box(0, 0, 23, 15), {{"", box(4, 4, 10, 10), RGB}});
    const Result cropped = run("--scene " + scene("box") + Program::small + "--quiet --report r --reference crop.exr");
    EXPECT_EQ(cropped.code, 2);
    EXPECT_THAT(cropped.output, AllOf(HasSubstr("4,4 to 10,10"), HasSubstr("24x16")));
}

TEST_F(CompareFiles, RefusesWhatCannotBeCompared) {
    write("a.exr", row({1, 2, 3}, {1, 1, 1}, {0, 0, 0}));
    write("tall.exr", Image{.size = {1, 3}, .channels = {{"R", {1, 2, 3}}}});
    write("other.exr", Image{.size = {3, 1}, .channels = {{"direct.R", {1, 2, 3}}}});
    const auto refusal = [&](const std::string& arguments) {
        const Result result = run("compare " + arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        return result.output;
    };
    EXPECT_THAT(refusal("a.exr tall.exr"),
                AllOf(HasSubstr("a.exr"), HasSubstr("3x1"), HasSubstr("1x3"), HasSubstr("tall.exr")));
    EXPECT_THAT(refusal("a.exr other.exr --json"),
                AllOf(HasSubstr("no layer"), HasSubstr("beauty"), HasSubstr("direct.R")));
    EXPECT_THAT(refusal("a.exr none.exr"), AllOf(HasSubstr("none.exr"), HasSubstr("No such file")));
    std::ofstream(folder / "a.png") << "no EXR";
    EXPECT_THAT(refusal("a.png a.exr"), AllOf(HasSubstr("a.png"), HasSubstr("not an EXR file")));
}

} // namespace
} // namespace vkpm
