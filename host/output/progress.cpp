/// How far a render is: one line redrawn on a terminal, a line now and then elsewhere.
#include "output/progress.h"
#include "interrupt.h"
#include "output/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace vkpm {
namespace {

constexpr double REDRAW_SECONDS = 0.1;
constexpr double LOG_SECONDS = 30;
constexpr size_t BAR_WIDTH = 30;

/// 0:07, 12:34 or 1:02:03.
std::string clockText(double seconds) {
    const auto s = static_cast<std::uint64_t>(std::clamp(seconds, 0.0, 1e12) + 0.5);
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

/// Rays per second with a prefix, three digits.
std::string rateText(double rate) {
    for (const char* unit : {"", "k", "M", "G"}) {
        if (rate < 999.5) return fmt::format("{:.3g} {}rays/s", rate, unit);
        rate /= 1000;
    }
    return fmt::format("{:.3g} Trays/s", rate);
}

size_t terminalColumns(std::FILE* file) {
    winsize size{};
    return ::ioctl(::fileno(file), TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

} // namespace

std::string progressLine(uint finished, const Goal& goal, double seconds, std::uint64_t rays, size_t columns, bool bar,
                         double error, const std::optional<PassForecast>& forecast) {
    const bool done = finished >= goal.passes;
    const uint rendered = finished - goal.first;
    const double most = done ? 1 : 1 - 1e-12; // while work is left, not 100 %
    const double toError = forecast ? finished / forecast->likely : error > 0 && error <= goal.error ? 1 : 0;
    const double part =
        std::clamp(std::max({double(finished) / goal.passes, seconds / goal.seconds, toError}), 0.0, most);
    const double left =
        rendered > 0 ? std::min(seconds / rendered * (goal.passes - finished), goal.seconds - seconds) : 0;
    const std::string passes = goal.passes == NONE ? "" : fmt::format("/{}", goal.passes);
    std::string line =
        fmt::format("pass {}{}  {} %  {} elapsed", finished, passes, uint(100 * part), clockText(seconds));
    const bool knownEnd = goal.passes != NONE || std::isfinite(goal.seconds);
    if (rendered > 0 && !done && knownEnd) line += fmt::format("  {} left", clockText(left));
    if (error > 0) line += fmt::format("  error {:.2g} %", 100 * error);
    if (forecast && rendered > 0 && !done)
        line += ", " + forecastText(goal.error, *forecast, finished, seconds / rendered);
    if (rays > 0 && seconds > 0) line += "  " + rateText(static_cast<double>(rays) / seconds);
    if (bar && line.size() + BAR_WIDTH + 4 <= columns) {
        const size_t full = size_t(BAR_WIDTH * part);
        line = fmt::format("[{:<{}}]  {}", std::string(full, '='), BAR_WIDTH, line);
    }
    return line.substr(0, columns);
}

std::string forecastText(double target, const PassForecast& forecast, uint passes, double secondsPerPass) {
    const auto until = [&](double count) { return clockText((count - passes) * secondsPerPass); };
    return fmt::format("{:.2g} % in about {} ({} to {})", 100 * target, until(forecast.likely), until(forecast.least),
                       until(forecast.most));
}

Progress::Progress(const Goal& aim, bool quiet, std::FILE* out)
    : goal(aim), file(quiet ? nullptr : out), terminal(::isatty(::fileno(out)) == 1), finished(aim.first),
      shown(aim.first) {
    if (file && terminal) draw(0);
}

Progress::~Progress() {
    if (!file) return;
    if (terminal) {
        drawn = interrupted() ? 0 : drawn;
        draw(lastSeconds);
        writeText(file, "\n");
    } else if (shown != finished) {
        log(lastSeconds);
    }
}

void Progress::estimate(uint passes, double error) {
    lastError = error;
    forecast.add(passes, error);
}

void Progress::update(uint done, std::uint64_t count) {
    update(done, count, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void Progress::update(uint done, std::uint64_t count, double seconds) {
    finished = std::min(done, goal.passes);
    rays = count;
    lastSeconds = seconds;
    if (!file || interrupted() || !due(seconds)) return;
    if (terminal) {
        draw(seconds);
        interval = REDRAW_SECONDS;
    } else {
        log(seconds);
        interval = std::clamp(2 * interval, 1.0, LOG_SECONDS);
    }
    reported = seconds;
}

/// Whether it is time for a report: at the first and last pass, and, off a terminal, if the next update would
/// come too late.
bool Progress::due(double seconds) const {
    if (finished == goal.passes) return shown != finished;
    if (finished == goal.first) return terminal && seconds - reported >= REDRAW_SECONDS;
    const double pass = terminal ? 0 : seconds / (finished - goal.first);
    return shown == goal.first || seconds - reported + pass > interval;
}

std::string Progress::line(double seconds, size_t columns, bool bar) const {
    const auto toGoal = goal.error > 0 ? forecast.passesTo(goal.error) : std::nullopt;
    return progressLine(finished, goal, seconds, rays, columns, bar, lastError, toGoal);
}

/// Writes over the line, blanks over what remains of a longer one.
void Progress::draw(double seconds) {
    const size_t columns = terminalColumns(file);
    const std::string text = line(seconds, columns, true);
    writeText(file, fmt::format("\r{:<{}}", text, std::min(drawn, columns)));
    drawn = text.size();
    shown = finished;
}

void Progress::log(double seconds) {
    writeText(file, line(seconds, 200, false) + "\n");
    shown = finished;
}

} // namespace vkpm
