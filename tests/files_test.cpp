/// Files that are read and written, and what the program leaves when its surroundings go: nothing is destroyed, nothing
/// is lost.
#include "output/event_log.h"
#include "output/exr.h"
#include "output/used_files.h"
#include "program.h"
#include <array>
#include <csignal>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace vkpm {
namespace {

using testing::HasSubstr;

class Files : public Program {
protected:
    void SetUp() override {
        Program::SetUp();
        for (const char* name : {"box.json", "glass.json", "knot.obj"})
            fs::copy_file(fs::path(VKPM_SCENES) / name, folder / name, fs::copy_options::overwrite_existing);
    }

    void expectRefused(const std::string& arguments, const std::string& what) const {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 2) << arguments << "\n" << result.output;
        EXPECT_THAT(result.output, HasSubstr(what)) << arguments;
    }
    int passesOf(const std::string& file) const {
        return std::stoi(readExrHeader(folder / file).attributes.at("passes"));
    }

    /// Starts the program with its stderr on a descriptor, waits until the log says that some passes are done, then
    /// does something to the process and returns how that ended.
    int endedBy(const std::function<void(pid_t)>& end, const std::string& arguments, int errors = -1) const {
        const pid_t child = ::fork();
        if (child == 0) {
            ::setpgid(0, 0);
            if (errors >= 0) ::dup2(errors, 2);
            const std::string command =
                fmt::format("cd '{}' && exec '" VKPM_PROGRAM "' {}", folder.string(), arguments);
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            ::_exit(127);
        }
        for (int i = 0; i < 6000 && bytesOf(folder / "log.jsonl").find("\"pass\":2") == std::string::npos; i++)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        end(child);
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    const std::string endless =
        "--scene box.json --size 24x16 --passes 1000000 --photons 500 --caustic-photons 500 -o x.exr --log log.jsonl ";
};

TEST_F(Files, OneFileUnderAnyName) {
    std::ofstream(folder / "a") << "a";
    std::ofstream(folder / "b") << "a";
    fs::create_symlink("a", folder / "link");
    fs::create_hard_link(folder / "a", folder / "hard");
    fs::create_symlink("later", folder / "dangling");
    fs::create_directory_symlink(folder, folder / "here");
    for (const char* other : {"a", "./a", "link", "hard", "here/a", "here/here/link"})
        EXPECT_TRUE(areOneFile(folder / "a", folder / other)) << other;
    EXPECT_FALSE(areOneFile(folder / "a", folder / "b"));
    for (const char* other : {"later", "./later", "dangling", "here/later", "here/dangling"})
        EXPECT_TRUE(areOneFile(folder / "later", folder / other)) << other;
    EXPECT_FALSE(areOneFile(folder / "later", folder / "sooner"));
    EXPECT_FALSE(areOneFile("/dev/null", "/dev/null"));
}

TEST_F(Files, OutputsNeverReplaceInputsOrEachOther) {
    ASSERT_EQ(run("--scene box.json" + small + "--quiet -o reference.exr").code, 0);
    fs::create_symlink("box.json", folder / "link.json");
    fs::create_hard_link(folder / "box.json", folder / "hard.json");
    fs::create_symlink("reference.exr", folder / "link.exr");
    const std::string box = "--scene box.json" + small, glass = "--scene glass.json" + small;
    std::map<std::string, std::string> before;
    for (const auto& entry : fs::directory_iterator(folder)) before[entry.path().filename()] = bytesOf(entry.path());
    before.erase("log.txt"); // what the program says

    for (const std::string command : {"", "view "}) {
        expectRefused(command + box + "--reference reference.exr --report r -o reference.exr",
                      "--output: found \"reference.exr\", the same file as --reference");
        expectRefused(command + box + "--reference reference.exr --report r -o link.exr",
                      "the same file as --reference (\"reference.exr\")");
        for (const char* option : {"--stats", "--log"}) {
            for (const char* name : {"box.json", "./box.json", "link.json", "hard.json"})
                expectRefused(command + box + option + " " + name,
                              fmt::format("{}: found \"{}\", the same file as the scene", option, name));
            expectRefused(command + box + "-o a.exr " + option + " a.png", "the same file as --output's PNG");
            expectRefused(command + box + "-o a.exr " + option + " ./a.exr", "the same file as --output (\"a.exr\")");
            expectRefused(command + box + option + " reference.exr --reference reference.exr --report r",
                          "the same file as --reference");
        }
        expectRefused(command + box + "--stats x --log x", "--log: found \"x\", the same file as --stats");
        expectRefused(command + box + "--stats error.csv --report .",
                      "--report: found \"./error.csv\", the same file as --stats");
    }
    // Meshes are known once the scene is read.
    expectRefused(glass + "--log knot.obj", "the same file as a file of the scene");
    expectRefused(glass + "--stats knot.obj", "the same file as a file of the scene");

    fs::remove(folder / "log.txt");
    std::map<std::string, std::string> after;
    for (const auto& entry : fs::directory_iterator(folder)) after[entry.path().filename()] = bytesOf(entry.path());
    EXPECT_TRUE(before == after);
}

TEST_F(Files, MergeKeepsWhatIsNotAmongItsParts) {
    const std::string box = "--scene box.json --size 24x16 --photons 500 --caustic-photons 300 --quiet ";
    for (const char* range : {"0:2", "2:4", "4:6"})
        ASSERT_EQ(run(box + "--pass-range " + range + " -o " + range[0] + ".exr").code, 0);
    ASSERT_EQ(run(box + "--seed 1 --passes 2 -o other.exr").code, 0);
    writeExr(folder / "stranger.exr", Image{{2, 2}, {{"R", {1, 2, 3, 4}}}, {}});
    const std::string two = bytesOf(folder / "2.exr"), other = bytesOf(folder / "other.exr"),
                      stranger = bytesOf(folder / "stranger.exr");
    expectRefused("merge 2.exr 0.exr", "not among the parts: it has passes 2 to 3");
    expectRefused("merge other.exr 0.exr 2.exr", "another render");
    expectRefused("merge stranger.exr 0.exr", "no render");
    fs::copy_file(folder / "0.exr", folder / "part.png");
    expectRefused("merge part.exr part.png", "the same file as a part");
    EXPECT_TRUE(bytesOf(folder / "2.exr") == two && bytesOf(folder / "other.exr") == other &&
                bytesOf(folder / "stranger.exr") == stranger);

    ASSERT_EQ(run("merge all.exr 0.exr 2.exr").code, 0);
    ASSERT_EQ(run("merge all.exr 0.exr 2.exr 4.exr").code, 0); // again, with what came in the meantime
    EXPECT_EQ(passesOf("all.exr"), 6);
    ASSERT_EQ(run("merge 0.exr 0.exr 2.exr").code, 0); // into a part
    EXPECT_EQ(passesOf("0.exr"), 4);
}

TEST_F(Files, AClosedTerminalSavesWhatThereIs) {
    EXPECT_EQ(endedBy([](pid_t child) { ::kill(child, SIGHUP), ::kill(child, SIGHUP); }, endless + "--quiet"), 130);
    EXPECT_GE(passesOf("x.exr"), 3);
}

TEST_F(Files, AReaderThatIsGoneEndsNothing) {
    for (const std::string log : {"--log log.jsonl", "--log log.jsonl --stats /dev/stderr"}) {
        fs::remove(folder / "log.jsonl");
        std::array<int, 2> pipe{};
        ASSERT_EQ(::pipe(pipe.data()), 0);
        ::close(pipe[0]);
        const std::string options =
            "--scene box.json --size 24x16 --passes 30 --photons 500 --caustic-photons 500 -o x.exr " + log;
        const int code = endedBy([](pid_t) {}, options, pipe[1]);
        ::close(pipe[1]);
        EXPECT_EQ(code, log.find("stats") == log.npos ? 0 : 1); // what was asked for could not be written
        EXPECT_EQ(passesOf("x.exr"), 30);
        fs::remove(folder / "x.exr");
    }
    // A log that is such a pipe ends, the render goes on.
    const Result piped = run("--scene box.json --size 24x16 --passes 30 --photons 500 --caustic-photons 500 --quiet -o "
                             "y.exr --log /dev/fd/3 3>&1 >&- | head -n 1; true");
    EXPECT_EQ(piped.code, 0) << piped.output;
    for (int i = 0; i < 1000 && !fs::exists(folder / "y.exr"); i++)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(passesOf("y.exr"), 30);
}

TEST_F(Files, AnInterruptBeforeTheFirstPassHasNothingToSave) {
    const Result result = run("--scene box.json --size 2048x2048 --photons 20000000 --quiet > said.txt 2>&1 & sleep "
                              "0.3; kill -INT $!; wait $!");
    EXPECT_EQ(result.code, 130);
    EXPECT_THAT(bytesOf(folder / "said.txt"), HasSubstr("vkpm: interrupted before the first pass: nothing to save"));
    EXPECT_FALSE(fs::exists(folder / "box.exr"));
}

// Limits of the process: drivers for the processor crash of them.
TEST_F(Files, LimitsOfTheProcessAreSaid) {
    const std::string render = "--scene box.json" + small + "--quiet -o x.exr";
    for (const auto& [limit, words] : {std::pair("ulimit -v 400000", "(ulimit -v)"),
                                       {"ulimit -f 100", "(ulimit -f)"},
                                       {"ulimit -f 5000", "(ulimit -f)"}}) {
#ifdef __SANITIZE_ADDRESS__
        if (std::string(limit).find("-v") != std::string::npos) continue; // the sanitizer takes terabytes of addresses
#endif
        const Result result = run(render, fmt::format("ulimit -c 0; {};", limit));
        EXPECT_EQ(result.code, 1) << limit << result.output;
        EXPECT_THAT(result.output, testing::AllOf(HasSubstr(words), HasSubstr("raise the limit"))) << limit;
        EXPECT_FALSE(fs::exists(folder / "x.exr"));
    }
#ifdef __SANITIZE_ADDRESS__
    const int secondsToRender = 30; // of processor time, with which the first pass is done
#else
    const int secondsToRender = 5;
#endif
    const Result timed = run("--scene box.json --size 64x64 --passes 1000000 --quiet -o x.exr",
                             fmt::format("ulimit -S -t {}; ulimit -H -t 600;", secondsToRender));
    EXPECT_EQ(timed.code, 130) << timed.output;
    EXPECT_GT(passesOf("x.exr"), 0);
}

TEST_F(Files, ALogTakesLinesFromAnyThread) {
    EventLog log(folder / "log.jsonl", false);
    log.write("early");
    EXPECT_FALSE(fs::exists(folder / "log.jsonl")); // nothing is touched before it is opened
    log.open();
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; t++)
            threads.emplace_back([&, t] {
                for (int i = 0; i < 500; i++) log.write("line", {{"thread", t}, {"i", i}});
            });
    }
    std::istringstream lines(bytesOf(folder / "log.jsonl"));
    int count = 0;
    for (std::string line; std::getline(lines, line); count++) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
    EXPECT_EQ(count, 2001);

    EventLog full(std::filesystem::path("/dev/full"), false); // the disk is full: several threads come upon it at once
    full.open();
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; t++)
        threads.emplace_back([&] {
            for (int i = 0; i < 100; i++) full.write("line");
        });
}

} // namespace
} // namespace vkpm
