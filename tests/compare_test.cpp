/// Error measures against values worked out by hand, the layers of an image, and vkpm compare on files.
#include "output/exr.h"
#include "output/layer_error.h"
#include "program.h"
#include <cmath>
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
    EXPECT_THAT(keys,
                ElementsAre("rmse", "relmse", "mean_error", "mean_relative_error", "max_error", "flip", "nonfinite"));
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
