/// How progress is reported, and what Ctrl-C does.
#include "interrupt.h"
#include "output/progress.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace vkpm {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Progress, LineNeverSaysAllWhileWorkIsLeft) {
    EXPECT_THAT(progressLine(199, {200}, 10, 0, 200, true), AllOf(HasSubstr("99 %"), HasSubstr(" ]")));
    EXPECT_THAT(progressLine(0xfffffffd, {0xfffffffe}, 10, 0, 200, true), AllOf(HasSubstr("99 %"), HasSubstr(" ]")));
    EXPECT_THAT(progressLine(200, {200}, 10, 0, 200, true),
                AllOf(HasSubstr("100 %"), HasSubstr("=]"), Not(HasSubstr("left"))));
}

TEST(Progress, LineEstimatesFromTheFinishedPasses) {
    EXPECT_EQ(progressLine(4, {16}, 20, 50'000'000, 200, false),
              "pass 4/16  25 %  0:20 elapsed  1:00 left  2.5 Mrays/s");
    EXPECT_THAT(progressLine(0, {16}, 0, 0, 200, true), AllOf(Not(HasSubstr("left")), Not(HasSubstr("rays"))));
    EXPECT_THAT(progressLine(1, {2}, 3723, 0, 200, false), HasSubstr("1:02:03 left"));
    for (const size_t columns : {0u, 1u, 20u, 79u, 120u})
        EXPECT_LE(progressLine(3, {16}, 20, 50'000'000, columns, true).size(), columns);
}

TEST(Progress, LineOfATimedRenderAndOfOneThatGoesOn) {
    EXPECT_EQ(progressLine(5, {NONE, 20}, 10, 0, 200, false), "pass 5  50 %  0:10 elapsed  0:10 left");
    EXPECT_THAT(progressLine(5, {NONE, 20}, 25, 0, 200, true), AllOf(HasSubstr("99 %"), HasSubstr(" ]")));
    EXPECT_EQ(progressLine(4, {8, 1e9, 2}, 10, 0, 200, false), "pass 4/8  50 %  0:10 elapsed  0:20 left");
    EXPECT_THAT(progressLine(2, {8, 1e9, 2}, 0, 0, 200, false), Not(HasSubstr("left")));
}

/// What a render of `passes` passes of `seconds` each writes to a file.
std::string logOf(uint passes, double seconds, bool quiet) {
    std::FILE* file = std::tmpfile();
    {
        Progress progress({passes}, quiet, file);
        for (uint i = 1; i <= passes; ++i) progress.update(i, i * 1000, i * seconds);
    }
    std::string text(static_cast<size_t>(std::ftell(file)), ' ');
    std::rewind(file);
    EXPECT_EQ(std::fread(text.data(), 1, text.size(), file), text.size());
    std::fclose(file);
    return text;
}

TEST(Progress, WritesALineNowAndThenOffATerminal) {
    EXPECT_EQ(logOf(16, 1, true), "");
    EXPECT_EQ(std::ranges::count(logOf(1, 1, false), '\n'), 1);
    for (const double seconds : {0.01, 1.0, 20.0}) {
        const std::string log = logOf(1000, seconds, false);
        const auto lines = std::ranges::count(log, '\n');
        EXPECT_THAT(log, AllOf(testing::StartsWith("pass 1/1000 "), HasSubstr("\npass 1000/1000 ")));
        EXPECT_THAT(log, Not(HasSubstr("\r")));
        EXPECT_GE(lines, 2 + std::floor(1000 * seconds / 30)) << seconds;
        EXPECT_LE(lines, 12 + 1000 * seconds / std::max(seconds, 30 - seconds)) << seconds;
    }
}

TEST(Progress, RedrawsOneLineOnATerminalAndEndsIt) {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) GTEST_SKIP() << "no pseudo terminal here";
    std::FILE* file = ::fdopen(::open(::ptsname(master), O_RDWR | O_NOCTTY), "w");
    ASSERT_NE(file, nullptr);
    const winsize size{.ws_row = 24, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
    ::ioctl(master, TIOCSWINSZ, &size);
    {
        Progress progress({200}, false, file);
        for (uint i = 1; i <= 150; ++i) progress.update(i, i * 1000, i * 0.01);
    }
    // The terminal hands its text on in parts, after a while.
    std::string text;
    for (pollfd ready{master, POLLIN, 0}; !text.ends_with('\n') && ::poll(&ready, 1, 5'000) > 0;) {
        std::array<char, 4096> part{};
        const ssize_t length = ::read(master, part.data(), part.size());
        if (length <= 0) break;
        text.append(part.data(), static_cast<size_t>(length));
    }
    std::fclose(file);
    ::close(master);
    const auto draws = std::ranges::count(text, '[');
    EXPECT_GE(draws, 12);
    EXPECT_LE(draws, 1 + 1 + 15 + 1);
    EXPECT_EQ(std::ranges::count(text, '\n'), 1);
    EXPECT_THAT(text, AllOf(testing::EndsWith("\r\n"), HasSubstr("pass 150/200"), Not(HasSubstr("\x1b"))));
}

TEST(InterruptDeathTest, TheFirstSetsAFlagTheSecondKills) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto interruptOnce = [](int signal) {
        catchInterrupts();
        onInterrupt("saving", false);
        if (interrupted()) std::_Exit(1);
        std::raise(signal);
        std::_Exit(interrupted() ? 0 : 2);
    };
    const auto interruptTwice = [] {
        catchInterrupts();
        onInterrupt("saving", false);
        std::raise(SIGINT);
        std::raise(SIGINT);
    };
    const auto hangUpTwice = [] {
        catchInterrupts();
        onInterrupt("saving", false);
        std::raise(SIGHUP); // a terminal that is closed, and then its shell
        std::raise(SIGHUP);
        std::_Exit(interrupted() ? 0 : 2);
    };
    const auto withoutAHangUp = [] { // under nohup
        std::signal(SIGHUP, SIG_IGN);
        catchInterrupts();
        onInterrupt("saving", false);
        std::raise(SIGHUP);
        std::_Exit(interrupted() ? 2 : 0);
    };
    const auto tooEarly = [] {
        catchInterrupts();
        onInterrupt("nothing to save", true);
        std::raise(SIGHUP);
    };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        EXPECT_EXIT(interruptOnce(signal), testing::ExitedWithCode(0), "vkpm: saving");
    EXPECT_EXIT(hangUpTwice(), testing::ExitedWithCode(0), "vkpm: saving");
    EXPECT_EXIT(withoutAHangUp(), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(tooEarly(), testing::ExitedWithCode(130), "vkpm: nothing to save");
    EXPECT_EXIT(interruptTwice(), testing::KilledBySignal(SIGINT), "vkpm: saving");
    EXPECT_FALSE(interrupted());
}

} // namespace
} // namespace vkpm
