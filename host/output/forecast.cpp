/// A line through logarithms.
#include "output/forecast.h"
#include <cmath>

namespace vkpm {
namespace {

// Of the shipped scenes: slopes of stated errors with their spread, and how far a single one is off its line.
const double usualSlope = -0.42, slopeSpread = 0.1, errorSpread = 0.08;

const double twoSided80 = 1.2816; // quantile of the normal distribution

} // namespace

void ErrorForecast::add(uint passes, double error) {
    if (!(error > 0) || passes <= last) return;
    last = passes;
    lastError = error;
    const double x = std::log(double(passes)), y = std::log(error);
    count++;
    sumX += x;
    sumXX += x * x;
    sumY += y;
    sumXY += x * y;
}

std::optional<PassForecast> ErrorForecast::passesTo(double target) const {
    if (count < 2 || lastError <= target) return {};
    const double meanX = sumX / count, meanY = sumY / count;
    // In units of the variance of a single error: what the prior weighs, and the points.
    const double prior = errorSpread * errorSpread / (slopeSpread * slopeSpread), points = sumXX - sumX * meanX;
    const double slope = (prior * usualSlope + sumXY - sumX * meanY) / (prior + points);
    if (slope >= -0.01) return {};                           // it does not fall
    const double apart = (std::log(target) - meanY) / slope; // from the middle of the curve
    const double variance = 1 + 1 / count + apart * apart / (prior + points);
    const double spread = twoSided80 * errorSpread * std::sqrt(variance) / -slope;
    const double likely = std::fmax(meanX + apart, std::log(last + 1.0));
    return PassForecast{std::fmax(std::exp(likely - spread), last + 1.0), std::exp(likely), std::exp(likely + spread)};
}

} // namespace vkpm
