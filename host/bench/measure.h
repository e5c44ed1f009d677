/// Time measurements in pairs, one of vkpm and one of its yardstick.
#pragma once
#include "gpu/gpu.h"
#include <functional>
#include <string>
#include <vector>

namespace vkpm {

/// What vkpm and its yardstick reach, both in `unit`, and the first over the second.
struct Measurement {
    std::string name;
    std::string against; // what the yardstick is
    std::string unit;
    double vkpm = 0;
    double yardstick = 0;
    double ratio = 0;
};

/// Seconds of a run of vkpm and of one of the yardstick right after it; the ratio is vkpm's over the yardstick's.
struct PairedSeconds {
    double vkpm = 0;
    double yardstick = 0;
    double ratio = 0;
};

/// Medians over pairs of runs, each after runs that do not count; the functions return the seconds that they took.
PairedSeconds measurePairs(const std::function<double()>& vkpm, const std::function<double()>& yardstick);

/// The upper one of an even number of values.
double median(std::vector<double> values);

/// The seconds of the wall clock that a function takes.
double wallSeconds(const std::function<void()>& work);

/// The seconds that a function spends in kernels, by the device's time stamps.
double kernelSeconds(const Gpu& gpu, const std::function<void()>& work);

/// Two times as rates: `amount` of `unit` over seconds.
Measurement asRate(std::string name, std::string against, std::string unit, double amount, const PairedSeconds& times);

/// Two times in milliseconds.
Measurement asTime(std::string name, std::string against, const PairedSeconds& times);

} // namespace vkpm
