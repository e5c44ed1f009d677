/// Medians of pairs: a machine that others use too slows both of a pair.
#include "bench/measure.h"
#include <algorithm>
#include <chrono>
#include <vector>

namespace vkpm {

static constexpr int warmUps = 2; // the first compiles the kernel
static constexpr int pairs = 11;
static constexpr double busySeconds = 0.1; // by when a GPU that rested has its clocks up

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + values.size() / 2);
    return values[values.size() / 2];
}

PairedSeconds measurePairs(const std::function<double()>& vkpm, const std::function<double()>& yardstick) {
    std::vector<double> first, second, ratios;
    for (int i = -warmUps; i < pairs; i++) {
        for (double busy = 0; busy < busySeconds;) busy += wallSeconds(vkpm);
        const double one = vkpm(), other = yardstick();
        if (i < 0) continue;
        first.push_back(one);
        second.push_back(other);
        ratios.push_back(one / other);
    }
    return {median(first), median(second), median(ratios)};
}

double wallSeconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

static double allKernels(const Gpu& gpu) {
    double seconds = 0;
    for (const auto& [name, time] : gpu.times) seconds += time.seconds;
    return seconds;
}

double kernelSeconds(const Gpu& gpu, const std::function<void()>& work) {
    const double before = allKernels(gpu);
    work();
    return allKernels(gpu) - before;
}

Measurement asRate(std::string name, std::string against, std::string unit, double amount, const PairedSeconds& times) {
    return {std::move(name),     std::move(against),       std::move(unit),
            amount / times.vkpm, amount / times.yardstick, 1 / times.ratio};
}

Measurement asTime(std::string name, std::string against, const PairedSeconds& times) {
    return {std::move(name), std::move(against), "ms", 1e3 * times.vkpm, 1e3 * times.yardstick, times.ratio};
}

} // namespace vkpm
