/// The command line: what it sets, what it leaves open, and what every refusal says.
#include "commands/options.h"
#include "error.h"
#include "scene/scene.h"
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

namespace vkpm {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Runs in a folder of its own that holds an (empty) scene file.
class OptionsTest : public testing::Test {
protected:
    OptionsTest() {
        fs::create_directories(folder);
        fs::current_path(folder);
        std::ofstream("box.json") << "{}";
    }
    ~OptionsTest() override {
        fs::current_path(before);
        fs::remove_all(folder);
    }

    static Options parse(std::vector<const char*> words) {
        words.insert(words.begin(), "vkpm");
        return parseOptions(static_cast<int>(words.size()), words.data());
    }

    /// The options of a render of the scene with further words.
    static RenderOptions render(std::vector<const char*> words) {
        words.insert(words.begin(), {"--scene", "box.json"});
        return std::get<RenderOptions>(parse(words));
    }

    static std::string text(std::vector<const char*> words) {
        return std::get<PrintOptions>(parse(std::move(words))).text;
    }

    static std::string refusal(const std::vector<const char*>& words) {
        try {
            parse(words);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    static std::string refusalOfRender(std::vector<const char*> words) {
        words.insert(words.begin(), {"--scene", "box.json"});
        return refusal(words);
    }

    const fs::path before = fs::current_path();
    const fs::path folder = fs::temp_directory_path() / fmt::format("vkpm_options_test.{}", ::getpid());
};

TEST_F(OptionsTest, LeavesOpenWhatIsNotGiven) {
    const RenderOptions options = render({});
    EXPECT_EQ(options.scene, "box.json");
    EXPECT_EQ(options.output, "box.exr");
    EXPECT_FALSE(options.stats || options.quiet);
    EXPECT_EQ(options.device, "");

    Settings scene;
    scene.size = {7, 5};
    scene.passes = 3;
    scene.photons = 11;
    scene.radius = 0.5f;
    scene.kernel = DENSITY_KERNEL_GAUSS;
    scene.schlick = true;
    scene.integrator = INTEGRATOR_PHOTON_MAP;
    scene.showPoints = true;
    scene.seed = 9;
    const Settings settings = options.over(scene);
    EXPECT_EQ(settings.size, scene.size);
    EXPECT_EQ(settings.passes, 3u);
    EXPECT_EQ(settings.photons, 11u);
    EXPECT_EQ(settings.radius, 0.5f);
    EXPECT_FALSE(settings.causticRadius);
    EXPECT_EQ(settings.kernel, DENSITY_KERNEL_GAUSS);
    EXPECT_TRUE(settings.schlick);
    EXPECT_EQ(settings.integrator, INTEGRATOR_PHOTON_MAP);
    EXPECT_TRUE(settings.showPoints);
    EXPECT_EQ(settings.seed, 9u);
}

TEST_F(OptionsTest, OverridesTheScene) {
    const RenderOptions options = render({"--size",
                                          "640x480",
                                          "--integrator",
                                          "photon-map",
                                          "--map",
                                          "caustic",
                                          "--show",
                                          "points",
                                          "--passes",
                                          "4",
                                          "--photons",
                                          "1e6",
                                          "--nearest",
                                          "50",
                                          "--caustic-photons",
                                          "0",
                                          "--radius",
                                          "0.25",
                                          "--caustic-radius=.125",
                                          "--kernel",
                                          "cone",
                                          "--fresnel",
                                          "schlick",
                                          "--pixel-samples",
                                          "9",
                                          "--gather-rays",
                                          "7",
                                          "--seed",
                                          "4294967295",
                                          "--device",
                                          "llvmpipe",
                                          "--quiet",
                                          "--stats",
                                          "s.json",
                                          "-o",
                                          "a.exr"});
    const Settings settings = options.over(Settings{});
    EXPECT_EQ(settings.size, uvec2(640, 480));
    EXPECT_EQ(settings.integrator, INTEGRATOR_PHOTON_MAP);
    EXPECT_TRUE(settings.showCaustic);
    EXPECT_TRUE(settings.showPoints);
    EXPECT_EQ(settings.passes, 4u);
    EXPECT_EQ(settings.photons, 1'000'000u);
    EXPECT_EQ(settings.causticPhotons, 0u);
    EXPECT_EQ(settings.nearest, 50u);
    EXPECT_EQ(settings.pixelSamples, 9u);
    EXPECT_EQ(settings.gatherRays, 7u);
    EXPECT_EQ(settings.radius, 0.25f);
    EXPECT_EQ(settings.causticRadius, 0.125f);
    EXPECT_EQ(settings.kernel, DENSITY_KERNEL_CONE);
    EXPECT_TRUE(settings.schlick);
    EXPECT_EQ(settings.seed, 0xffffffffu);
    EXPECT_EQ(options.device, "llvmpipe");
    EXPECT_TRUE(options.quiet);
    EXPECT_EQ(options.stats, "s.json");
    EXPECT_EQ(options.output, "a.exr");
}

TEST_F(OptionsTest, CanTakeBackWhatTheSceneSwitchesOn) {
    Settings scene;
    scene.schlick = true;
    scene.integrator = INTEGRATOR_PHOTON_MAP;
    scene.showCaustic = scene.showPoints = true;
    const RenderOptions options = render({"--fresnel", "exact", "--map", "global", "--show", "estimate"});
    const Settings settings = options.over(scene);
    EXPECT_FALSE(settings.schlick || settings.showCaustic || settings.showPoints);
}

TEST_F(OptionsTest, KnowsTheCommands) {
    EXPECT_TRUE(std::holds_alternative<RenderOptions>(parse({"render", "--scene", "box.json"})));
    EXPECT_FALSE(std::get<DevicesOptions>(parse({"devices"})).json);
    EXPECT_TRUE(std::get<DevicesOptions>(parse({"devices", "--json"})).json);
    const auto bench = std::get<BenchOptions>(parse({"bench", "--json", "--scene", "box.json", "--device", "1"}));
    EXPECT_TRUE(bench.json);
    EXPECT_EQ(bench.scene, "box.json");
    EXPECT_EQ(bench.device, "1");
    EXPECT_EQ(std::get<BenchOptions>(parse({"bench"})).scene, "");
    const auto merge = std::get<MergeOptions>(parse({"merge", "all.exr", "b.exr", "--part", "a.exr"}));
    EXPECT_EQ(merge.output, "all.exr");
    EXPECT_EQ(merge.parts, (std::vector<fs::path>{"b.exr", "a.exr"}));
    EXPECT_TRUE(merge.isPart);
    const auto compare = std::get<CompareOptions>(parse({"compare", "a.exr", "--json", "b.exr"}));
    EXPECT_EQ(compare.image, "a.exr");
    EXPECT_EQ(compare.reference, "b.exr");
    EXPECT_TRUE(compare.json);
    EXPECT_THAT(refusal({"compare", "a.exr"}),
                AllOf(HasSubstr("found 1 file;"), HasSubstr("vkpm compare IMAGE REFERENCE")));
    EXPECT_THAT(refusal({"compare", "a.exr", "b.exr", "c.exr"}), HasSubstr("found 3 files;"));
    EXPECT_THAT(refusal({"compare", "a.exr", "b.exr", "--jsn"}), HasSubstr("did you mean --json?"));
    EXPECT_THAT(refusal({"merge", "all.exr"}), HasSubstr("vkpm merge OUT.exr PART.exr..."));
    EXPECT_THAT(refusal({"merge", "all.png", "a.exr"}), HasSubstr(".exr"));
}

TEST_F(OptionsTest, ReadsWhatEndsSavesAndGoesOn) {
    const RenderOptions options = render({"--time", "1.5", "--pass-range", "4:16", "--resume", "--checkpoint", "60",
                                          "--log", "l.jsonl", "--alpha", "1"});
    EXPECT_EQ(options.seconds, 1.5);
    EXPECT_EQ(options.passRange->begin, 4u);
    EXPECT_EQ(options.passRange->end, 16u);
    EXPECT_TRUE(options.resume);
    EXPECT_EQ(options.checkpoint, 60.0);
    EXPECT_EQ(options.log, "l.jsonl");
    EXPECT_EQ(options.over(Settings{}).alpha, 1.0f);
    EXPECT_THAT(refusalOfRender({"--passes", "8", "--pass-range", "4:9"}), HasSubstr("passes below the 8"));
}

TEST_F(OptionsTest, PrintsHelpAndVersion) {
    const Settings defaults;
    for (const auto& words : std::vector<std::vector<const char*>>{
             {}, {"--help"}, {"-h"}, {"render", "--help"}, {"--passes", "x", "--help"}, {"--unknown", "--help"}}) {
        const std::string help = text(words);
        EXPECT_THAT(help, AllOf(HasSubstr("--caustic-photons"), HasSubstr("130"), HasSubstr("world units")));
        EXPECT_THAT(help, HasSubstr(fmt::format("(default {})", defaults.photons)));
        EXPECT_THAT(help, HasSubstr(fmt::format("(default {}x{})", defaults.size.x, defaults.size.y)));
    }
    for (const auto& words :
         std::vector<std::vector<const char*>>{{"--version"}, {"compare", "--version"}, {"--passes", "x", "--version"}})
        EXPECT_TRUE(std::holds_alternative<VersionOptions>(parse(words)));
    EXPECT_THAT(text({"compare", "--help"}),
                AllOf(HasSubstr("IMAGE REFERENCE"), HasSubstr("mean(x - r)"), HasSubstr("FLIP")));
    EXPECT_THAT(text({"devices", "--help"}), AllOf(HasSubstr("--json"), Not(HasSubstr("--scene"))));
}

TEST_F(OptionsTest, RefusesWrongValuesNamingTheOptionAndWhatIsAllowed) {
    struct Case {
        const char *option, *value, *allowed;
    };
    for (const Case& c : std::vector<Case>{
             {"--passes", "0", "from 1 to"},
             {"--passes", "2.5", "whole number"},
             {"--passes", "1e99", "from 1 to"},
             {"--passes", "12abc", "whole number"},
             {"--photons", "-3", "from 0 to"},
             {"--photons", "2147483648", "2147483647"},
             {"--photons", "nan", "whole number"},
             {"--photons", "0x10", "whole number"},
             {"--photons", " 3", "whole number"},
             {"--caustic-photons", "inf", "whole number"},
             {"--nearest", "many", "whole number"},
             {"--seed", "4294967296", "4294967295"},
             {"--pixel-samples", "257", "from 1 to 256"},
             {"--gather-rays", "0", "from 1 to 1024"},
             {"--radius", "0", "above 0"},
             {"--radius", "-1", "above 0"},
             {"--radius", "nan", "world units"},
             {"--radius", "1e99", "above 0"},
             {"--caustic-radius", "1m", "above 0"},
             {"--size", "640", "WIDTHxHEIGHT"},
             {"--size", "0x480", "from 1 to 65536"},
             {"--size", "640x", "WIDTHxHEIGHT"},
             {"--size", "65537x1", "65536"},
             {"--size", "65536x65536", "268435456"},
             {"--size", "640x480x3", "WIDTHxHEIGHT"},
             {"--size", "1.5x2", "WIDTHxHEIGHT"},
             {"--integrator", "pathh", "did you mean path?"},
             {"--integrator", "vcm", "photon, path, direct, photon-map, light"},
             {"--kernel", "box", "constant, cone, gauss, epanechnikov"},
             {"--fresnel", "none", "exact, schlick"},
             {"--map", "both", "global, caustic"},
             {"--show", "all", "estimate, points"},
             {"--output", "a.png", ".exr"},
             {"--output", ".exr", ".exr"},
             {"--output", "none/a.exr", "folder that exists"},
             {"--stats", "none/s.json", "folder that exists"},
             {"--stats", ".", "folder"},
             {"--stats", "box.exr", "--output"},
             {"--log", "box.exr", "--output"},
             {"--time", "0", "seconds"},
             {"--checkpoint", "-1", "seconds"},
             {"--alpha", "0", "above 0"},
             {"--alpha", "1.5", "at most 1"},
             {"--pass-range", "16", "FIRST:END"},
             {"--pass-range", "4:4", "FIRST below END"},
             {"--pass-range", "0:2.5", "whole"},
             {"--pass-range", ":4", "0:16"},
             {"--pass-range", "0:3000000000", "at most"},
             {"--device", "--quiet", "a value"},
         })
        EXPECT_THAT(refusalOfRender({c.option, c.value}),
                    AllOf(HasSubstr(c.option), HasSubstr(fmt::format("found \"{}\"", c.value)), HasSubstr(c.allowed)));
}

TEST_F(OptionsTest, RefusesWrongScenes) {
    EXPECT_THAT(refusal({"--quiet"}), HasSubstr("--scene: missing"));
    EXPECT_THAT(refusal({"render"}), HasSubstr("--scene: missing"));
    EXPECT_THAT(refusal({"--scene", "none.json"}), AllOf(HasSubstr("--scene"), HasSubstr("none.json")));
    EXPECT_THAT(refusal({"--scene", "."}), AllOf(HasSubstr("--scene"), HasSubstr("folder")));
    EXPECT_THAT(refusal({"bench", "--scene", "none.json"}), HasSubstr("none.json"));
}

TEST_F(OptionsTest, AWindowTakesTheOptionsOfARender) {
    const auto options =
        std::get<ViewOptions>(parse({"view", "--scene", "box.json", "--size", "64x48", "--passes", "3"}));
    EXPECT_EQ(options.size, uvec2(64, 48));
    EXPECT_EQ(options.output, "box.exr");
    EXPECT_THAT(text({"view", "--help"}),
                AllOf(HasSubstr("vkpm view --scene FILE"), HasSubstr("default no end"), HasSubstr("Closing it saves")));
    EXPECT_THAT(refusal({"view"}), HasSubstr("vkpm view --scene FILE"));
}

TEST_F(OptionsTest, RefusesUnknownWordsAndSuggestsTheNearest) {
    EXPECT_THAT(refusal({"--sceen", "box.json"}), AllOf(HasSubstr("--sceen"), HasSubstr("did you mean --scene?")));
    EXPECT_THAT(refusalOfRender({"--pass=3"}), HasSubstr("did you mean --passes?"));
    EXPECT_THAT(refusalOfRender({"--zoom", "3"}), AllOf(HasSubstr("--zoom: unknown"), Not(HasSubstr("mean"))));
    EXPECT_THAT(refusalOfRender({"-q"}), HasSubstr("-q: unknown"));
    EXPECT_THAT(refusal({"devices", "--scene", "box.json"}), HasSubstr("--scene: unknown"));
    EXPECT_THAT(refusal({"rendr"}), AllOf(HasSubstr("rendr"), HasSubstr("did you mean render?")));
    EXPECT_THAT(refusal({"show"}), HasSubstr("allowed: render, view, plan, compare, merge, devices, bench"));
    EXPECT_THAT(refusal({"box.json"}), HasSubstr("--scene box.json"));
    EXPECT_THAT(refusalOfRender({"extra"}), HasSubstr("\"extra\""));
}

TEST_F(OptionsTest, RefusesMissingRepeatedAndSuperfluousValues) {
    EXPECT_THAT(refusalOfRender({"--passes"}), HasSubstr("--passes: found no value"));
    EXPECT_THAT(refusalOfRender({"--passes", "3", "--passes", "4"}), HasSubstr("--passes: found more than one value"));
    EXPECT_THAT(refusalOfRender({"--quiet=3"}), HasSubstr("--quiet"));
}

TEST_F(OptionsTest, RefusesPhotonMapOptionsElsewhere) {
    EXPECT_THAT(refusalOfRender({"--integrator", "path", "--map", "global"}),
                AllOf(HasSubstr("--map"), HasSubstr("path"), HasSubstr("--integrator photon-map")));
    const RenderOptions options = render({"--show", "estimate"});
    EXPECT_THROW(options.over(Settings{}), InputError);
}

} // namespace
} // namespace vkpm
