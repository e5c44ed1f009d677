/// Renders that go on, are cut into parts, stopped by time, killed, or run out of disk.
#include "draw.h"
#include "output/exr.h"
#include "program.h"
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <random>
#include <spawn.h>
#include <thread>

namespace vkpm {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Resume : public Program {
protected:
    const std::string box = "--scene " + scene("box") + " --size 24x16 --photons 500 --caustic-photons 300 --quiet ";

    void render(const std::string& arguments) const {
        const Result result = run(box + arguments);
        EXPECT_EQ(result.code, 0) << result.output;
    }
    void merge(const std::string& arguments) const {
        const Result result = run("merge " + arguments);
        EXPECT_EQ(result.code, 0) << result.output;
    }
    std::string refusal(const std::string& arguments) const {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 2) << arguments << "\n" << result.output;
        return result.output;
    }
    void expectSameFiles(const std::string& a, const std::string& b) const {
        for (const char* kind : {".exr", ".png"})
            EXPECT_TRUE(bytesOf(folder / (a + kind)) == bytesOf(folder / (b + kind))) << a << " and " << b << kind;
    }
    int passesOf(const std::string& file) const {
        return std::stoi(readExrHeader(folder / file).attributes.at("passes"));
    }
};

TEST_F(Resume, HalvesAndPartsGiveTheFileOfOneRun) {
    render("--passes 21 -o whole.exr");
    render("--passes 9 -o halves.exr");
    render("--passes 21 --resume -o halves.exr");
    expectSameFiles("halves", "whole");
    render("--passes 21 --resume -o halves.exr"); // nothing left to do
    expectSameFiles("halves", "whole");
    render("--passes 21 --resume -o fresh.exr"); // nothing there yet
    expectSameFiles("fresh", "whole");

    for (const auto& [range, name] : {std::pair("0:5", "a"), {"5:6", "b"}, {"6:16", "c"}, {"16:21", "d"}})
        render(fmt::format("--pass-range {} -o {}.exr", range, name));
    merge("ordered.exr a.exr b.exr c.exr d.exr");
    expectSameFiles("ordered", "whole");
    merge("shuffled.exr d.exr b.exr a.exr c.exr");
    expectSameFiles("shuffled", "whole");
    merge("--part inner.exr c.exr b.exr");
    merge("nested.exr d.exr inner.exr a.exr");
    expectSameFiles("nested", "whole");
    render("--pass-range 16:19 -o e.exr");
    render("--pass-range 16:21 --resume -o e.exr");
    expectSameFiles("e", "d");
    merge("a.exr a.exr"); // over its own part
    EXPECT_EQ(passesOf("a.exr"), 5);
}

/// Channels of a file by name.
std::map<std::string, std::vector<float>> channelsOf(const fs::path& file) {
    std::map<std::string, std::vector<float>> channels;
    for (const Channel& channel : readExr(file).channels) channels[channel.name] = channel.values;
    return channels;
}

// Without sums a file has the same picture in fewer bytes, and is refused where it cannot go on.
TEST_F(Resume, APictureAloneIsTheSamePicture) {
    render("--passes 7 -o whole.exr");
    render("--passes 7 --no-resume -o picture.exr");
    const auto whole = channelsOf(folder / "whole.exr"), picture = channelsOf(folder / "picture.exr");
    EXPECT_EQ(picture.size(), 31u);
    for (const auto& [name, values] : picture)
        EXPECT_TRUE(std::memcmp(values.data(), whole.at(name).data(), values.size() * sizeof(float)) == 0) << name;
    EXPECT_TRUE(bytesOf(folder / "picture.png") == bytesOf(folder / "whole.png"));
    EXPECT_THAT(refusal(box + "--passes 9 --resume -o picture.exr"),
                HasSubstr("picture.exr: was saved with --no-resume"));
    EXPECT_THAT(refusal("merge x.exr picture.exr"), HasSubstr("was saved with --no-resume"));
    for (const char* option : {"--resume", "--checkpoint 1", "--pass-range 0:4"})
        EXPECT_THAT(refusal(box + "--no-resume -o x.exr " + option), HasSubstr("found with --no-resume")) << option;
}

TEST_F(Resume, HalfFloatsGoOnWithTheBitsOfOneRun) {
    render("--passes 7 --half -o half.exr");
    render("--passes 21 --half --resume -o half.exr");
    render("--passes 21 --half -o whole.exr");
    expectSameFiles("half", "whole");
    render("--passes 21 -o float.exr");
    const auto half = channelsOf(folder / "half.exr"), exact = channelsOf(folder / "float.exr");
    double most = 0;
    for (const char* name : {"R", "G", "B", "direct.R", "indirect.G", "albedo.B"})
        for (std::size_t i = 0; i < exact.at(name).size(); i++)
            if (exact.at(name)[i] > 1e-4f)
                most = std::max(most, std::abs(double(half.at(name)[i]) / exact.at(name)[i] - 1));
    EXPECT_GT(most, 1e-5);
    EXPECT_LE(most, 0x1p-11);
    EXPECT_TRUE(half.at("depth.Z") == exact.at("depth.Z"));

    // A lamp too bright for half floats: said, and finite.
    json bright = json::parse(bytesOf(scene("box")));
    for (json& shape : bright["shapes"])
        if (shape.contains("emission")) shape["emission"] = 1e6;
    std::ofstream(folder / "bright.json") << bright;
    const Result result = run(
        "--scene bright.json --size 24x16 --passes 1 --photons 500 --caustic-photons 300 --quiet --half -o bright.exr");
    EXPECT_EQ(result.code, 0);
    EXPECT_THAT(result.output, AllOf(HasSubstr("warning: bright.exr: "), HasSubstr("larger than 65504")));
    const auto saved = channelsOf(folder / "bright.exr").at("emission.R");
    EXPECT_EQ(*std::ranges::max_element(saved), 65504);
}

TEST_F(Resume, MergeRefusesByName) {
    for (const char* range : {"0:4", "2:6", "4:8", "12:16"})
        render(fmt::format("--pass-range {} -o {}.exr", range,
                           std::string(range).replace(std::string(range).find(':'), 1, "-")));
    EXPECT_THAT(refusal("merge x.exr 0-4.exr 2-6.exr"),
                AllOf(HasSubstr("0-4.exr and 2-6.exr"), HasSubstr("passes 2 to 3")));
    EXPECT_THAT(refusal("merge x.exr 0-4.exr 0-4.exr"), HasSubstr("passes 0 to 3"));
    EXPECT_THAT(refusal("merge x.exr 12-16.exr 0-4.exr 4-8.exr"),
                AllOf(HasSubstr("passes 8 to 11 are missing"), HasSubstr("4-8.exr and 12-16.exr")));
    EXPECT_THAT(refusal("merge x.exr 4-8.exr"), AllOf(HasSubstr("passes 0 to 3 are missing"), HasSubstr("--part")));

    const std::string other =
        "--scene " + scene("box") + " --size 24x16 --photons 600 --caustic-photons 300 --quiet --pass-range 4:8 -o ";
    EXPECT_EQ(run(other + "photons.exr").code, 0);
    EXPECT_THAT(refusal("merge x.exr 0-4.exr photons.exr"),
                AllOf(HasSubstr("photons.exr"), HasSubstr("photons: 600"), HasSubstr("500")));
    EXPECT_EQ(run("--scene " + scene("ring") +
                  " --size 24x16 --photons 500 --caustic-photons 300 --quiet --pass-range 4:8 -o ring.exr")
                  .code,
              0);
    EXPECT_THAT(refusal("merge x.exr 0-4.exr ring.exr"), AllOf(HasSubstr("ring.exr"), HasSubstr("scene: /")));
    EXPECT_EQ(run("--scene " + scene("box") +
                  " --size 24x16 --photons 500 --caustic-photons 300 --quiet --seed 1 --pass-range 4:8 -o seed.exr")
                  .code,
              0);
    EXPECT_THAT(refusal("merge x.exr 0-4.exr seed.exr"), HasSubstr("seed: 1"));

    writeExr(folder / "stranger.exr", Image{{2, 2}, {{"R", {1, 2, 3, 4}}}, {}});
    EXPECT_THAT(refusal("merge x.exr 0-4.exr stranger.exr"), HasSubstr("stranger.exr: is not a render of vkpm"));
    const std::string whole = bytesOf(folder / "4-8.exr");
    std::ofstream(folder / "cut.exr", std::ios::binary) << whole.substr(0, whole.size() / 2);
    EXPECT_THAT(refusal("merge x.exr 0-4.exr cut.exr"), HasSubstr("cut.exr"));
    EXPECT_THAT(refusal("merge x.exr 0-4.exr nothere.exr"), HasSubstr("nothere.exr"));
    EXPECT_FALSE(fs::exists(folder / "x.exr"));
}

TEST_F(Resume, RefusesOtherSettingsWithWhatDiffers) {
    render("--passes 3 -o x.exr");
    const std::string before = bytesOf(folder / "x.exr");
    const std::string same =
        "--scene " + scene("box") + " --size 24x16 --caustic-photons 300 --quiet --passes 6 --resume -o x.exr ";
    EXPECT_THAT(refusal(same + "--photons 501"), AllOf(HasSubstr("x.exr"), HasSubstr("photons: 501 here, 500 there")));
    EXPECT_THAT(refusal(same + "--photons 500 --alpha 1 --kernel cone"),
                AllOf(HasSubstr("alpha: 1.0 here"), HasSubstr("kernel: \"cone\" here")));
    EXPECT_THAT(refusal(same + "--photons 500 --radius 0.1"), HasSubstr("radius: 0.1"));
    EXPECT_THAT(refusal(box + "--pass-range 1:6 --resume -o x.exr"),
                AllOf(HasSubstr("passes 0 to 2"), HasSubstr("begins with pass 1")));
    EXPECT_TRUE(bytesOf(folder / "x.exr") == before);

    Image cropped = readExr(folder / "x.exr");
    cropped.size.y = 8;
    for (Channel& channel : cropped.channels) channel.values.resize(24 * 8);
    writeExr(folder / "cropped.exr", cropped);
    EXPECT_THAT(refusal(box + "--passes 6 --resume -o cropped.exr"),
                AllOf(HasSubstr("cropped.exr"), HasSubstr("24x8")));

    // What a scene says of itself and how many passes it wants may change, what it shows may not.
    json text = json::parse(bytesOf(scene("box")));
    text["about"] = "another text";
    text["settings"]["passes"] = 5;
    std::ofstream(folder / "box2.json") << text;
    EXPECT_EQ(run("--scene box2.json --size 24x16 --photons 500 --caustic-photons 300 --quiet --resume -o x.exr").code,
              0);
    EXPECT_EQ(passesOf("x.exr"), 5);
    text["camera"]["fieldOfView"] = 31;
    std::ofstream(folder / "box2.json") << text;
    EXPECT_THAT(refusal("--scene box2.json --size 24x16 --photons 500 --caustic-photons 300 --quiet --resume -o x.exr"),
                HasSubstr("scene: /camera/fieldOfView"));
}

TEST_F(Resume, TimeIsKeptWithinOnePass) {
    for (const double seconds : {0.5, 2.0}) {
        const Result result =
            run("--scene " + scene("box") + " --size 96x64 --photons 20000 --quiet --stats s.json -o x.exr --time " +
                std::to_string(seconds));
        ASSERT_EQ(result.code, 0) << result.output;
        const json stats = json::parse(bytesOf(folder / "s.json"));
        const double rendered = stats["seconds"]["render"];
        const double pass = rendered / stats["passes"].get<double>();
        std::printf("--time %.1f: %.3f s, %d passes of %.3f s\n", seconds, rendered, stats["passes"].get<int>(), pass);
        // "Within one pass" of the mean length; single passes differ, the first compiles kernels.
        EXPECT_NEAR(rendered, seconds, std::max(1.5 * pass, 0.1));
    }
    render("--time 1000 --passes 3 -o y.exr"); // the first that is reached
    EXPECT_EQ(passesOf("y.exr"), 3);
}

// A child that renders for ever, saving all the time.
class Child {
public:
    Child(const fs::path& folder, const std::string& sceneFile) {
        const std::string output = folder / "x.exr", log = folder / "log.jsonl";
        std::vector<std::string> words{VKPM_PROGRAM, "--scene",           sceneFile, "--size",  "24x16",    "--photons",
                                       "500",        "--caustic-photons", "300",     "--quiet", "--passes", "100000",
                                       "--resume",   "--checkpoint",      "0.05",    "--log",   log,        "-o",
                                       output};
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        EXPECT_EQ(::posix_spawn(&pid, VKPM_PROGRAM, nullptr, nullptr, arguments.data(), environ), 0);
    }
    ~Child() {
        ::kill(pid, SIGKILL);
        ::waitpid(pid, nullptr, 0);
    }

private:
    pid_t pid = 0;
};

// The last checkpoint that the log says is done; a line may be cut off.
int lastCheckpoint(const fs::path& log) {
    int passes = 0;
    std::ifstream file(log);
    for (std::string line; std::getline(file, line);) {
        const json event = json::parse(line, nullptr, false);
        if (event.is_object() && event["event"] == "checkpoint") passes = event["passes"];
    }
    return passes;
}

TEST_F(Resume, KilledAtAnyMomentItLosesAnIntervalAtMost) {
    const fs::path output = folder / "x.exr";
    std::mt19937 random(3);
    const int enough = isNightly() ? 24 : 8;
    int before = 0, kills = 0;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(8);
    while ((kills < enough || before < 30) && std::chrono::steady_clock::now() < deadline) {
        {
            const Child child(folder, scene("box"));
            // From its first save on, or, now and then, during the start.
            const int checkpoints = lastCheckpoint(folder / "log.jsonl");
            for (int wait = 0; kills % 4 != 0 && wait < 600 && lastCheckpoint(folder / "log.jsonl") == checkpoints;
                 wait++)
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 200'000));
        }
        kills++;
        if (!fs::exists(output)) continue;
        const Image image = readExr(output); // opens, whole
        const int passes = std::stoi(image.attributes.at("passes"));
        ASSERT_GE(passes, before);
        ASSERT_GE(passes, lastCheckpoint(folder / "log.jsonl"));
        before = passes;
    }
    EXPECT_GE(kills, enough);
    ASSERT_GE(before, 30);
    std::printf("%d kills, %d passes saved\n", kills, before);

    render(fmt::format("--passes {} --resume -o x.exr", before + 3));
    render(fmt::format("--passes {} -o y.exr", before + 3));
    expectSameFiles("x", "y");
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) files += entry.path().string().ends_with(".part");
    EXPECT_EQ(files, 0) << "left by the killed";
}

// A small disk of its own, in a namespace that only this test sees.
TEST_F(Resume, AFullDiskLeavesTheLastGoodFile) {
    render("--passes 2 -o x.exr");
    fs::create_directory(folder / "disk");
    const auto kibibytes = 3 * (fs::file_size(folder / "x.exr") + fs::file_size(folder / "x.png")) / 2 / 1024;
    const std::string space = std::string("unshare --mount ") + (::geteuid() == 0 ? "" : "--map-root-user ") +
                              "sh -c 'mount -t tmpfs -o size=" + std::to_string(kibibytes) +
                              "k none disk && cp x.exr x.png disk && ";
    const auto shell = [&](const std::string& command) {
        const int status =
            std::system(("cd " + folder.string() + " && " + space + command + "' > log.txt 2>&1").c_str());
        return Result{WEXITSTATUS(status), bytesOf(folder / "log.txt")};
    };
    if (shell("true").code != 0) GTEST_SKIP() << "no small disk can be mounted here: " << bytesOf(folder / "log.txt");

    const std::string program = VKPM_PROGRAM " " + box;
    const std::string keep = "; code=$?; cp disk/x.exr kept.exr; ls disk; exit $code";
    const Result atEnd = shell(program + "--passes 3 --resume -o disk/x.exr" + keep);
    EXPECT_EQ(atEnd.code, 1);
    EXPECT_THAT(atEnd.output, AllOf(HasSubstr("disk/x.exr"), HasSubstr("No space left"), Not(HasSubstr(".part"))));
    EXPECT_TRUE(bytesOf(folder / "kept.exr") == bytesOf(folder / "x.exr"));

    // On the way it is a warning: space may come back before the end.
    const Result onTheWay = shell(program + "--time 3 --resume --checkpoint 0.2 -o disk/x.exr" + keep);
    EXPECT_EQ(onTheWay.code, 1);
    EXPECT_THAT(onTheWay.output, AllOf(HasSubstr("warning: checkpoint"), HasSubstr("rendering goes on")));
    EXPECT_TRUE(bytesOf(folder / "kept.exr") == bytesOf(folder / "x.exr"));
}

} // namespace
} // namespace vkpm
