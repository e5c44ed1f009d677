/// Machines that fail: no memory on the device, a device that is lost, a driver that computes wrongly, folders that
/// cannot be written to. Exit code 1 with what helps, and nothing saved is lost.
#include "output/exr.h"
#include "program.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace vkpm {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Machine : public Program {
protected:
    /// Runs the program on a driver that fails as the layer is told.
    Result runOn(const std::string& failure, const std::string& arguments) const {
        return run(arguments,
                   "VK_ADD_LAYER_PATH='" VKPM_LAYERS "' VK_INSTANCE_LAYERS=VK_LAYER_VKPM_hostile " + failure);
    }
    const std::string anySize = "--scene " + scene("box") + " --caustic-photons 300 --quiet ";
    const std::string box = anySize + "--size 24x16 ";
    int passesOf(const std::string& file) const {
        return std::stoi(readExrHeader(folder / file).attributes.at("passes"));
    }

    /// The number of photons that a refusal says would fit.
    static uint advisedPhotons(const std::string& output) {
        const std::size_t place = output.find("--photons ");
        EXPECT_NE(place, std::string::npos) << output;
        return place == std::string::npos ? 0 : static_cast<uint>(std::stoul(output.substr(place + 10)));
    }
};

// The layer itself does no harm.
TEST_F(Machine, ALayerThatDoesNothingChangesNothing) {
    EXPECT_EQ(run(box + "--passes 2 --photons 500 -o a.exr").code, 0);
    const Result result = runOn("VKPM_LAYER_LOST=1000000", box + "--passes 2 --photons 500 -o b.exr");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(bytesOf(folder / "a.exr") == bytesOf(folder / "b.exr"));
}

// Too many photons: the number that the refusal says fits, and a quarter more does not.
TEST_F(Machine, OutOfDeviceMemorySaysHowManyPhotonsFit) {
    for (const uint mebibytes : {40u, 100u}) {
        fs::remove(folder / "x.exr");
        const std::string memory = fmt::format("VKPM_LAYER_MEMORY={}", mebibytes << 20);
        const Result refused = runOn(memory, box + "--passes 2 --photons 2000000 -o x.exr");
        EXPECT_EQ(refused.code, 1);
        EXPECT_THAT(refused.output, AllOf(HasSubstr("MiB of device memory for 'global"),
                                          HasSubstr("vkAllocateMemory: ErrorOutOfDeviceMemory")));
        EXPECT_FALSE(fs::exists(folder / "x.exr"));
        const uint most = advisedPhotons(refused.output);
        std::printf("%u MiB: %u photons\n", mebibytes, most);
        EXPECT_GT(most, 50'000u);
        const Result fitting = runOn(memory, box + fmt::format("--passes 2 --photons {} -o x.exr", most));
        EXPECT_EQ(fitting.code, 0) << fitting.output;
        EXPECT_EQ(runOn(memory, box + fmt::format("--passes 2 --photons {} -o x.exr", most / 4 * 5)).code, 1);
    }
    const Result caustic = runOn("VKPM_LAYER_MEMORY=60000000",
                                 "plan --scene " + scene("box") + " --size 24x16 --photons 1000 --caustic-photons 3e6");
    EXPECT_EQ(caustic.code, 1);
    EXPECT_THAT(caustic.output, AllOf(HasSubstr("--photons 1000 --caustic-photons "), HasSubstr("'caustic")));
}

TEST_F(Machine, AnImageThatDoesNotFitIsSaid) {
    const Result result = runOn("VKPM_LAYER_MEMORY=20000000", anySize + "--size 2000x2000 --photons 500 -o x.exr");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, AllOf(HasSubstr("2000x2000"), HasSubstr("--size")));
}

// Drivers for the processor grant memory that is not there; the program counts for itself.
TEST_F(Machine, MoreThanTheDeviceHasIsRefusedBeforeItIsUsed) {
    const Result result = run(anySize + "--size 65536x4096 --passes 1000000 --photons 500 -o x.exr");
    EXPECT_EQ(result.code, 1) << result.output;
    EXPECT_THAT(result.output, AllOf(HasSubstr("of device memory for 'film'"), HasSubstr("MiB were free")));
}

// The device is lost in the middle: what the last checkpoint saved is whole, and the render goes on from it.
TEST_F(Machine, ALostDeviceLosesNothingSaved) {
    const std::string options = box + "--passes 40 --photons 500 ";
    EXPECT_EQ(run(options + "-o whole.exr").code, 0);
    int before = 0, saved = 0;
    for (int submission = 60; saved < 3; submission += submission / 4) {
        ASSERT_LT(submission, 2000);
        const Result lost = runOn(fmt::format("VKPM_LAYER_LOST={}", submission),
                                  options + "--checkpoint 0.000001 --resume --log log.jsonl -o x.exr");
        EXPECT_EQ(lost.code, 1) << lost.output;
        EXPECT_THAT(lost.output, HasSubstr("ErrorDeviceLost"));
        if (!fs::exists(folder / "x.exr")) continue; // within the first pass, where the host copies to and fro
        saved++;
        EXPECT_THAT(lost.output, AllOf(HasSubstr("running commands on the device failed"),
                                       HasSubstr("x.exr holds the first "), HasSubstr("--resume goes on from there")));
        EXPECT_THAT(bytesOf(folder / "log.jsonl"), HasSubstr("\"event\":\"failed\""));
        EXPECT_GT(passesOf("x.exr"), before);
        before = passesOf("x.exr");
        EXPECT_LT(before, 40);
    }
    EXPECT_EQ(run(options + "--resume -o x.exr").code, 0);
    EXPECT_TRUE(bytesOf(folder / "x.exr") == bytesOf(folder / "whole.exr"));
    EXPECT_TRUE(bytesOf(folder / "x.png") == bytesOf(folder / "whole.png"));
}

TEST_F(Machine, ADeviceLostAtAnyMomentIsSaid) {
    for (int submission = 1; submission < 30; submission += 4) {
        const Result lost =
            runOn(fmt::format("VKPM_LAYER_LOST={}", submission), box + "--passes 8 --photons 500 -o x.exr");
        EXPECT_EQ(lost.code, 1) << submission;
        EXPECT_THAT(lost.output, HasSubstr("ErrorDeviceLost")) << submission;
        EXPECT_FALSE(fs::exists(folder / "x.exr")) << submission;
    }
}

// As stock Mesa 22.3 does.
TEST_F(Machine, ADriverThatEndsLoopsFailsTheAudit) {
    for (const std::string& command : {box + "-o x.exr", "plan --scene " + scene("box")}) {
        const Result result = runOn("VKPM_LAYER_TRIPS=65535", command);
        EXPECT_EQ(result.code, 1) << result.output;
        EXPECT_THAT(result.output, AllOf(HasSubstr("computes wrongly"),
                                         HasSubstr("long loops run to their end: invocation 0 computed"),
                                         HasSubstr("install a newer one")));
    }
    EXPECT_FALSE(fs::exists(folder / "x.exr"));
    const Result devices = runOn("VKPM_LAYER_TRIPS=65535", "devices");
    EXPECT_EQ(devices.code, 0);
    EXPECT_THAT(devices.output, HasSubstr("long loops run to their end: FAILED"));
}

// Asked before rendering, which takes long. A folder that is not there is a mistake in the command line; one that lets
// nobody write is not.
TEST_F(Machine, FoldersThatCannotBeWrittenTo) {
    fs::create_directory(folder / "folder.exr");
    std::ofstream(folder / "file") << "x";
    const std::pair<const char*, int> places[] = {{"-o nothere/x.exr", 2},
                                                  {"-o file/x.exr", 2},
                                                  {"-o folder.exr", 2},
                                                  {"-o x.exr --stats nothere/s.json", 2},
                                                  {"-o x.exr --log nothere/l.jsonl", 2},
                                                  {"-o /proc/x.exr", 1},
                                                  {"-o /sys/x.exr", 1},
                                                  {"-o x.exr --report file", 1},
                                                  {"-o x.exr --report /proc/report", 1}};
    for (const auto& [where, code] : places) {
        const Result result = run(box + "--passes 100000 --photons 500 " + where);
        EXPECT_EQ(result.code, code) << where << result.output;
        EXPECT_THAT(result.output, testing::StartsWith("vkpm: ")) << where;
        EXPECT_FALSE(fs::exists(folder / "x.exr")) << where;
    }
    EXPECT_THAT(run(box + "-o nothere/x.exr").output, HasSubstr("create it first"));
}

TEST_F(Machine, AReadOnlyFolderIsNamed) {
    const std::string mount = std::string("unshare --mount ") + (::geteuid() == 0 ? "" : "--map-root-user ") +
                              "sh -c 'mkdir -p disk && mount -t tmpfs -o ro none disk && ";
    const auto shell = [&](const std::string& command) {
        const int status =
            std::system(("cd " + folder.string() + " && " + mount + command + "' > log.txt 2>&1").c_str());
        return Result{WEXITSTATUS(status), bytesOf(folder / "log.txt")};
    };
    if (shell("true").code != 0)
        GTEST_SKIP() << "no folder can be made read-only here: " << bytesOf(folder / "log.txt");
    const Result result = shell("timeout 60 " VKPM_PROGRAM " " + box + "--passes 100000 -o disk/x.exr");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, AllOf(HasSubstr("disk/x.exr: open: Read-only file system"),
                                     HasSubstr("choose a folder that you may write to")));
}

TEST_F(Machine, AFullStandardOutputIsAFailure) {
    for (const char* command : {"devices", "--help", "devices --json"}) {
        const int status = std::system(
            fmt::format("cd {} && {} {} > /dev/full 2> log.txt", folder.string(), VKPM_PROGRAM, command).c_str());
        EXPECT_EQ(WEXITSTATUS(status), 1) << command;
        EXPECT_THAT(bytesOf(folder / "log.txt"), HasSubstr("No space left on device")) << command;
    }
}

} // namespace
} // namespace vkpm
