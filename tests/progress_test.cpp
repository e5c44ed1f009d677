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

TEST(Progress, LineSaysWhenTheErrorWillBeReached) {
    const Goal goal{.passes = NONE, .error = 0.05};
    EXPECT_EQ(progressLine(10, goal, 20, 0, 200, false, 0.1, PassForecast{30, 40, 70}),
              "pass 10  25 %  0:20 elapsed  error 10 %, 5 % in about 1:00 (0:40 to 2:00)");
    EXPECT_THAT(progressLine(10, goal, 20, 0, 200, false, 0.1), Not(HasSubstr("about")));
    EXPECT_THAT(progressLine(10, goal, 20, 0, 200, false, 0.04), HasSubstr("99 %"));
}

TEST(ErrorForecast, FollowsTheCurve) {
    for (const double slope : {-0.34, -0.42, -0.5}) {
        ErrorForecast forecast;
        EXPECT_FALSE(forecast.passesTo(0.01));
        const auto error = [&](double passes) { return 0.3 * std::pow(passes, slope); };
        for (const uint passes : {8u, 10u, 13u, 17u, 22u}) forecast.add(passes, error(passes));
        // At a tenth of the way.
        const auto found = forecast.passesTo(error(220));
        ASSERT_TRUE(found);
        EXPECT_GT(found->likely, 220 / 1.5) << slope;
        EXPECT_LT(found->likely, 220 * 1.5) << slope;
        EXPECT_LT(found->least, 220) << slope;
        EXPECT_GT(found->most, 220) << slope;
        EXPECT_FALSE(forecast.passesTo(error(22))); // it is there
        // The longer the curve, the more certain.
        for (const uint passes : {28u, 35u, 44u, 55u, 69u, 87u}) forecast.add(passes, error(passes));
        const auto later = forecast.passesTo(error(220));
        EXPECT_LT(later->most / later->least, found->most / found->least) << slope;
        EXPECT_NEAR(later->likely, 220, 30) << slope;
    }
    ErrorForecast rising;
    rising.add(8, 0.1);
    for (const uint passes : {16u, 32u, 64u, 128u, 256u}) rising.add(passes, 0.1 * passes);
    EXPECT_FALSE(rising.passesTo(0.01));
}

// Errors that renders of shipped scenes at 64 x 64 pixels stated, one after 8 passes and each a quarter later, and what
// was forecast of each from a tenth of its passes on.
TEST(ErrorForecast, IsTrueOfShippedScenes) {
    const std::array<std::vector<double>, 7> scenes{
        {{5.57, 5.2, 4.77, 4.08, 3.47, 3.14, 3.18, 2.64, 2.68, 2.41, 2.15, 1.93, 1.81, 1.51},
         {6.18, 5.76, 5.36, 4.61, 3.87, 3.39, 3.52, 2.83, 2.9, 2.67, 2.32, 2.09, 1.97, 1.62},
         {7.5, 6.94, 6.73, 6.02, 5.42, 4.89, 4.58, 3.99, 3.79, 3.56, 3.14, 2.92, 2.68, 2.37},
         {6.47, 6.1, 5.61, 5.21, 4.75, 4.3, 4.24, 3.77, 3.76, 3.54, 3.24, 3, 2.85, 2.51},
         {4.27, 3.68, 4.05, 3.28, 2.29, 2.03, 2.36, 1.75, 1.91, 1.85, 1.51, 1.42, 1.38, 1.09},
         {10.6, 9.2, 8.03, 7.24, 6.41, 5.65, 4.98, 4.21, 4.2, 3.68, 3.29, 2.97, 2.57, 2.25},
         {10.4, 8.59, 8.01, 6.8, 5.52, 4.72, 4.49, 3.47, 3.47, 3.23, 2.67, 2.39, 2.23,
          1.78}}}; // percent: box, diffuse_box, glass, pool, ring, rings, wine
    const std::array<uint, 14> passes{8, 10, 13, 17, 22, 28, 35, 44, 55, 69, 87, 109, 137, 172};
    uint all = 0, near = 0, within = 0;
    for (const std::vector<double>& errors : scenes) {
        for (std::size_t end = 4; end < errors.size(); end++) {
            const double target = errors[end];
            if (std::any_of(errors.begin(), errors.begin() + std::ptrdiff_t(end),
                            [&](double e) { return e <= target; }))
                continue;
            ErrorForecast forecast;
            for (std::size_t i = 0; i < end; i++) {
                forecast.add(passes[i], errors[i]);
                if (i < 2 || 10 * passes[i] < passes[end]) continue;
                const auto found = forecast.passesTo(target);
                ASSERT_TRUE(found);
                const double ratio = found->likely / passes[end];
                all++;
                near += ratio < 1.5 && ratio > 1 / 1.5;
                within += found->least <= passes[end] && passes[end] <= found->most;
            }
        }
    }
    std::printf("of %u forecasts %u are within a factor of 1.5, and %u of the intervals hold\n", all, near, within);
    EXPECT_GE(near, 0.9 * all);
    EXPECT_GE(within, 0.8 * all);
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
