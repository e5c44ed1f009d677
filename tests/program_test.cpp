/// The program as its users run it: exit codes, files, refusals, determinism, and what an interrupt leaves.
#include "output/exr.h"
#include "output/image.h"
#include "program.h"
#include "scene_text.h"
#include <csignal>
#include <gmock/gmock.h>
#include <thread>

namespace vkpm {
namespace {

using testing::HasSubstr;

TEST_F(Program, RendersEveryShippedSceneWithoutLossOrNonfinite) {
    for (const char* name : {"box", "diffuse_box", "ring", "glass", "pool"}) {
        const Result result = run("--scene " + scene(name) + small + "--stats stats.json --quiet");
        EXPECT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(result.output, "");
        EXPECT_TRUE(fs::exists(folder / (std::string(name) + ".exr")) &&
                    fs::exists(folder / (std::string(name) + ".png")));
        const auto stats = nlohmann::json::parse(std::ifstream(folder / "stats.json"));
        EXPECT_EQ(stats["nonfinite"], 0);
        for (const char* map : {"global", "caustic"}) {
            const auto& p = stats["photons"][map];
            EXPECT_EQ(p["emitted"].get<int>(),
                      p["absorbed"].get<int>() + p["escaped"].get<int>() + p["lost"].get<int>())
                << name << map;
            EXPECT_EQ(p["lost"], 0);
        }
    }
}

/// Mean of three channels of a file: those of beauty, or of a layer if a prefix is given.
double meanOf(const fs::path& file, const std::string& prefix = "") {
    double sum = 0;
    std::size_t count = 0;
    for (const Channel& channel : readExr(file).channels)
        if (channel.name == prefix + "R" || channel.name == prefix + "G" || channel.name == prefix + "B") {
            sum += std::accumulate(channel.values.begin(), channel.values.end(), 0.0);
            count += channel.values.size();
        }
    return sum / double(std::max<std::size_t>(count, 1));
}

// The same light however it is found, but for noise and blur; of one kind alone, that kind.
TEST_F(Program, EveryIntegratorKernelAndViewRenders) {
    const std::string with =
        "--scene " + scene("box") + " --size 24x16 --photons 5000 --caustic-photons 5000 --quiet -o x.exr --passes ";
    ASSERT_EQ(run(with + "16").code, 0);
    const double whole = meanOf(folder / "x.exr"), direct = meanOf(folder / "x.exr", "direct."),
                 caustic = meanOf(folder / "x.exr", "caustic.");
    for (const char* options : {"256 --integrator path", "16 --kernel cone", "16 --kernel gauss",
                                "16 --kernel epanechnikov", "16 --nearest 10", "16 --fresnel schlick", "16 --seed 7"}) {
        const Result result = run(with + options);
        ASSERT_EQ(result.code, 0) << options << result.output;
        EXPECT_NEAR(meanOf(folder / "x.exr"), whole, 0.05 * whole) << options;
    }
    ASSERT_EQ(run(with + "16 --integrator direct").code, 0);
    EXPECT_NEAR(meanOf(folder / "x.exr", "direct."), direct, 0.03 * direct);
    ASSERT_EQ(run(with + "64 --integrator light").code, 0);
    EXPECT_NEAR(meanOf(folder / "x.exr", "caustic."), caustic, 0.2 * caustic);
    for (const char* options :
         {"4 --integrator photon-map", "4 --integrator photon-map --show points",
          "4 --integrator photon-map --map caustic", "4 --integrator photon-map --map caustic --show points"}) {
        const Result result = run(with + options);
        ASSERT_EQ(result.code, 0) << options << result.output;
        EXPECT_GT(meanOf(folder / "x.exr"), 0.001) << options;
    }
}

// Each measurement checks itself that both sides did the same work, or throws.
TEST_F(Program, BenchMeasures) {
    const Result result = run("bench --json --scene " + scene("box"));
    ASSERT_EQ(result.code, 0) << result.output;
    const auto bench = nlohmann::json::parse(result.output);
    for (const char* name : {"primary_rays", "bounce_rays", "shadow_rays", "sort", "gather", "copy", "random_copy"}) {
        EXPECT_GT(bench[name]["vkpm"], 0) << name;
        EXPECT_GT(bench[name]["yardstick"], 0) << name;
        EXPECT_GT(bench[name]["ratio"], 0) << name;
    }
}

// As if the host could not write the device's memory.
TEST_F(Program, StagedMemoryGivesTheSameFiles) {
    EXPECT_EQ(run("--scene " + scene("box") + small + "--quiet -o a.exr").code, 0);
    ::setenv("VKPM_STAGING", "1", 1);
    const Result staged = run("--scene " + scene("box") + small + "--quiet -o b.exr --stats b.json");
    const Result planned = run("plan --json --scene " + scene("box") + small);
    ::unsetenv("VKPM_STAGING");
    EXPECT_EQ(planned.code, 0) << planned.output;
    EXPECT_EQ(staged.code, 0) << staged.output;
    EXPECT_TRUE(bytesOf(folder / "a.png") == bytesOf(folder / "b.png"));
    EXPECT_NE(bytesOf(folder / "b.json").find("staging"), std::string::npos) << "nothing was staged";
}

TEST_F(Program, TwoRunsWriteTheSameFiles) {
    for (const char* file : {"a.exr", "b.exr"})
        EXPECT_EQ(run("--scene " + scene("box") + small + "--quiet -o " + file).code, 0);
    EXPECT_TRUE(bytesOf(folder / "a.exr") == bytesOf(folder / "b.exr"));
    EXPECT_TRUE(bytesOf(folder / "a.png") == bytesOf(folder / "b.png"));
    EXPECT_GT(fs::file_size(folder / "a.exr"), 1000u);
}

TEST_F(Program, LayersSumToBeauty) {
    ASSERT_EQ(run("--scene " + scene("box") + small + "--quiet -o a.exr").code, 0);
    std::map<std::string, std::vector<float>> channels;
    for (const Channel& channel : readExr(folder / "a.exr").channels) channels[channel.name] = channel.values;
    for (const std::string c : {"R", "G", "B"})
        for (std::size_t i = 0; i < channels[c].size(); i++) {
            double sum = 0;
            for (const char* layer : {"emission.", "direct.", "specular.", "caustic.", "indirect."})
                sum += channels.at(layer + c)[i];
            EXPECT_NEAR(channels[c][i], sum, 1e-6 * (1 + sum));
        }
}

TEST_F(Program, RefusalsNameFileAndPlace) {
    const std::pair<const char*, const char*> refusals[] = {
        {R"({"camera": {"origin": [0, 0, 3], "target": [0, 0, 0], "fieldOfView": 40}, "shapes": []})", "/shapes"},
        {R"({"camera": {"origin": [0, 0, 3], "target": [0, 0, 0], "fieldOfView": 40}, "materials": {}, "colour": 1, "shapes": []})",
         "/colour"},
        {R"({"camera": {"origin": [0, 0, 3], "target": [0, 0, 0], "fieldOfView": 40}, "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": -1, "emission": 1}]})",
         "/shapes/0/radius"},
        {R"({"camera": {"origin": [0, 0, 3], "target": [0, 0, 0], "fieldOfView": 40}, "shapes": [{"type": "mesh", "file": "nothere.obj", "emission": 1}]})",
         "/shapes/0/file"},
        {R"({"shapes": [{"type": "sphere", "center": [0, 0, NaN], "radius": 1, "emission": 1}]})", "scene.json:1:"}};
    for (const auto& [text, place] : refusals) {
        std::ofstream(folder / "scene.json") << text;
        const Result result = run("--scene scene.json");
        EXPECT_EQ(result.code, 2) << text;
        EXPECT_THAT(result.output, testing::AllOf(HasSubstr("scene.json"), HasSubstr(place))) << text;
        EXPECT_FALSE(fs::exists(folder / "scene.exr"));
    }
    EXPECT_EQ(run("--scene nothere.json").code, 2);
    EXPECT_EQ(run("--frobnicate").code, 2);
    EXPECT_EQ(run("--scene " + scene("box") + " --device nosuchdevice").code, 1);
}

TEST_F(Program, AWindowNeedsADisplay) {
    const Result result = run("view --scene " + scene("box"), "env -u DISPLAY -u WAYLAND_DISPLAY");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output,
                testing::AllOf(HasSubstr("glfwInit failed"), HasSubstr("vkpm --scene FILE renders without one")));
    EXPECT_FALSE(fs::exists(folder / "box.exr"));
}

TEST_F(Program, DevicesShowsAPassedAudit) {
    const Result result = run("devices --json");
    EXPECT_EQ(result.code, 0);
    const auto devices = nlohmann::json::parse(result.output);
    ASSERT_GE(devices.size(), 1u);
    EXPECT_GE(devices[0]["audit"].size(), 5u);
    for (const auto& test : devices[0]["audit"]) EXPECT_TRUE(test["passed"].get<bool>()) << test;
}

TEST_F(Program, PlanSaysWhatIsLeftOutAndTheMemory) {
    for (const char* name : {"diffuse_box", "box"}) {
        const std::string options =
            "--scene " + scene(name) + " --size 64x48 --passes 7 --photons 5000 --caustic-photons 2000";
        const Result planned = run("plan --json " + options);
        ASSERT_EQ(planned.code, 0) << planned.output;
        const auto plan = nlohmann::json::parse(planned.output);
        ASSERT_EQ(run(options + " --quiet --stats s.json -o x.exr").code, 0);
        const auto stats = nlohmann::json::parse(std::ifstream(folder / "s.json"));
        EXPECT_NEAR(plan["memory"]["device_bytes"].get<double>() / stats["memory"]["device_bytes"].get<double>(), 1,
                    0.1)
            << name;

        std::size_t without = 0;
        for (const auto& feature : plan["features"]) {
            EXPECT_EQ(feature["needed"].get<bool>(), stats["features"][feature["name"].get<std::string>()] != 0)
                << feature;
            if (feature["needed"]) continue;
            EXPECT_EQ(stats["left_out"][without++],
                      feature["name"].get<std::string>() + ": " + feature["reason"].get<std::string>());
        }
        EXPECT_EQ(without, stats["left_out"].size());
        for (const auto& kernel : plan["kernels"])
            EXPECT_LE(kernel["instructions"], kernel["general_instructions"]) << kernel;
    }
    EXPECT_THAT(run("plan --size 64x48 --scene " + scene("diffuse_box")).output,
                testing::AllOf(HasSubstr("Left out:"), HasSubstr("hasTint"), HasSubstr("film")));
    EXPECT_EQ(run("plan").code, 2);
}

// Ctrl-C after some passes: exit 130, and the file holds what was rendered.
TEST_F(Program, InterruptSavesWhatThereIs) {
    const fs::path output = folder / "box.exr";
    const fs::path log = folder / "progress.txt";
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const std::string file = scene("box");
        if (!std::freopen(log.c_str(), "w", stderr)) ::_exit(126);
        ::execl(VKPM_PROGRAM, VKPM_PROGRAM, "--scene", file.c_str(), "--size", "24x16", "--passes", "1000000",
                "--photons", "500", "--caustic-photons", "500", "-o", output.c_str(), nullptr);
        ::_exit(127);
    }
    for (int tenths = 0; tenths < 1200 && bytesOf(log).find("pass 1/") == std::string::npos; tenths++)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::kill(child, SIGINT);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    const Image image = readExr(output);
    EXPECT_GE(std::stoi(image.attributes.at("passes")), 1);
}

} // namespace
} // namespace vkpm
