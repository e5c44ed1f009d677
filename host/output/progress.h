/// How far a render is: one line redrawn on a terminal, a line now and then elsewhere.
#pragma once
#include "output/forecast.h"
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

namespace vkpm {

/// What a render is to reach, and where it begins: whichever of passes, seconds and error comes first ends it.
struct Goal {
    uint passes; // NONE if they do not count
    double seconds = std::numeric_limits<double>::infinity();
    uint first = 0;   // passes that were there before
    double error = 0; // relative
};

/// Passes done, percent, time elapsed and left, and rays per second, in at most `columns` characters; a bar if
/// there is room for one and `bar` is set. Time left comes from the mean of the finished passes. `error` is the last
/// estimate, if there is one, and `forecast` says when it will be the goal.
std::string progressLine(uint finished, const Goal& goal, double seconds, std::uint64_t rays, size_t columns, bool bar,
                         double error = 0, const std::optional<PassForecast>& forecast = {});

/// "5 % in about 2:10 (1:30 to 3:20)", for a render that has taken some seconds for each of its passes.
std::string forecastText(double target, const PassForecast& forecast, uint passes, double secondsPerPass);

/// Reports to `file` (stderr); ends its line when destroyed, and writes nothing between an interrupt and that.
class Progress {
public:
    Progress(const Goal& goal, bool quiet, std::FILE* file = stderr);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `finished` passes are done, with `rays` in all of them.
    void update(uint finished, std::uint64_t rays);

    /// The relative error after some passes.
    void estimate(uint passes, double error);

    /// The same at a given time since the beginning, in seconds.
    void update(uint finished, std::uint64_t rays, double seconds);

private:
    std::string line(double seconds, size_t columns, bool bar) const;
    void draw(double seconds);
    void log(double seconds);
    bool due(double seconds) const;

    Goal goal;
    std::FILE* file; // null if silent
    bool terminal;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    uint finished;
    std::uint64_t rays = 0;
    uint shown;             // passes finished at the last report
    double lastSeconds = 0; // of the last update
    double lastError = 0;
    ErrorForecast forecast;
    double reported = 0; // time of the last report
    double interval = 0; // least time between reports
    size_t drawn = 0;    // characters on the line
};

} // namespace vkpm
