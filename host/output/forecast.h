/// When a render will have reached an error, by the errors that it has stated so far.
#pragma once
#include "shared.h"
#include <optional>

namespace vkpm {

/// A number of passes, and the interval around it that holds eight renders of ten.
struct PassForecast {
    double least;
    double likely;
    double most;
};

/// The logarithm of the error falls as a straight line over that of the passes. Its slope is known beforehand to lie
/// about that of the shipped scenes, and the more exactly the longer the curve is (Bayesian linear regression, Bishop
/// 2006, section 3.3).
class ErrorForecast {
public:
    /// An error above 0 after some passes, more than before.
    void add(uint passes, double error);
    /// Passes after which the error will be down to `target`; nothing with less than two errors, or if it is there.
    std::optional<PassForecast> passesTo(double target) const;

private:
    uint last = 0;
    double lastError = 0;
    double count = 0, sumX = 0, sumXX = 0, sumY = 0, sumXY = 0; // of logarithms: x passes, y error
};

} // namespace vkpm
