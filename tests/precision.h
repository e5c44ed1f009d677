/// How far single precision is off: in ulps, and in roundings of what went in and came out.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace vkpm {

/// The distance of neighbouring floats about a number.
inline double ulpOf(double x) {
    return std::ldexp(1.0, std::max(std::ilogb(std::max(std::abs(x), 0x1p-126)), -126) - 23);
}

/// The floats of a struct of floats, as doubles.
template <class T> auto doublesOf(const T& value) {
    std::array<float, sizeof(T) / 4> floats;
    std::memcpy(floats.data(), &value, sizeof(T));
    std::array<double, sizeof(T) / 4> doubles;
    std::ranges::copy(floats, doubles.begin());
    return doubles;
}

/// Errors of one function over many inputs. A rounding is what it takes to move the exact result as far: half an ulp of
/// the result and of each input. Where a function is ill-conditioned an error is many ulps and yet few roundings.
class Precision {
public:
    Precision(std::string function, std::string inputs) : name(std::move(function)), where(std::move(inputs)) {}

    /// Compares `found` with exact(inputs), a function of an array of doubles; leaves out what is not finite.
    template <std::size_t N> void add(double found, std::array<double, N> inputs, auto&& exact) {
        const double y = exact(inputs);
        double unit = ulpOf(y) / 2;
        for (double& input : inputs) {
            const double before = input, step = ulpOf(before) / 2;
            input = before + step;
            const double above = exact(inputs);
            input = before - step;
            unit += std::max(std::abs(above - y), std::abs(exact(inputs) - y));
            input = before;
        }
        if (!std::isfinite(unit) || !std::isfinite(y)) return;
        addError(std::abs(found - y), ulpOf(y), unit);
    }

    void addError(double error, double ulp, double unit) {
        const double inUlps = std::isnan(error) ? INFINITY : error / ulp,
                     inRoundings = std::isnan(error) ? INFINITY : error / unit;
        count++;
        maxUlps = std::max(maxUlps, inUlps);
        sumUlps += inUlps;
        maxRoundings = std::max(maxRoundings, inRoundings);
        sumRoundings += inRoundings;
    }

    std::string row() const {
        return fmt::format("| {} | {} | {:.3g} | {:.2g} | {:.3g} | {:.2g} |", name, where, maxUlps, sumUlps / count,
                           maxRoundings, sumRoundings / count);
    }

    std::string name, where;
    double count = 0, maxUlps = 0, sumUlps = 0, maxRoundings = 0, sumRoundings = 0;
};

} // namespace vkpm
