/// What FLIP's observer sees through: separable filters over a tile of pixels.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vkpm {

// A tile, and the same with the pixels around it that filters reach into.
constexpr size_t TILE = 64;
constexpr size_t HALO = 10;
constexpr size_t PADDED = TILE + 2 * HALO;
using Plane = std::array<float, TILE * TILE>;
using PaddedPlane = std::array<float, PADDED * PADDED>;

/// Weights of a pixel's neighbours along one axis, itself in the middle.
template <size_t RADIUS> using Taps = std::array<float, 2 * RADIUS + 1>;

/// The contrast sensitivity of the eye to each of three opponents (Andersson et al. 2020, table 1), that to blue and
/// yellow as a sum of two filters, and its detectors of edges and points: derivatives of a Gaussian (section 4.2).
class FlipFilters {
public:
    using Sensitivity = Taps<HALO>; // three standard deviations of the widest, rounded up
    using Detector = Taps<9>;       // the same

    Sensitivity brightness = sensitivity(1, 0.0047);
    Sensitivity redGreen = sensitivity(1, 0.0053);
    Sensitivity blueYellowWide = sensitivity(34.1, 0.04);
    Sensitivity blueYellowNarrow = sensitivity(13.5, 0.025);
    Detector smooth = detector([](double, double gauss) { return gauss; });
    Detector edge = detector([](double x, double gauss) { return -x * gauss; });
    Detector point = detector([](double x, double gauss) { return (x * x - 1) * gauss; });

    FlipFilters() {
        scale(brightness, 1 / sum(brightness));
        scale(redGreen, 1 / sum(redGreen));
        const double both = std::hypot(sum(blueYellowWide), sum(blueYellowNarrow));
        scale(blueYellowWide, 1 / both);
        scale(blueYellowNarrow, 1 / both);
        scale(smooth, 1 / sum(smooth));
        balance(edge);
        balance(point);
    }

private:
    /// A screen 0.7 m wide of 3840 pixels, looked at from a distance of 0.7 m.
    static constexpr double PIXELS_PER_DEGREE = 3840 * std::numbers::pi / 180;

    /// The root, as far as it varies along one axis, of a sqrt(pi / b) exp(-pi^2 x^2 / b) with x in degrees: both axes
    /// together have the factor once.
    static Sensitivity sensitivity(double a, double b) {
        Sensitivity taps;
        for (size_t i = 0; i < taps.size(); ++i) {
            const double x = std::numbers::pi * (static_cast<double>(i) - HALO) / PIXELS_PER_DEGREE;
            taps[i] = static_cast<float>(std::sqrt(a * std::sqrt(std::numbers::pi / b)) * std::exp(-x * x / b));
        }
        return taps;
    }

    /// A function of x in standard deviations, and of exp(-x^2 / 2). Edges of 0.082 degrees are seen best.
    template <class Function> static Detector detector(Function function) {
        const double deviation = 0.082 / 2 * PIXELS_PER_DEGREE;
        Detector taps;
        for (size_t i = 0; i < taps.size(); ++i) {
            const double x = (static_cast<double>(i) - 9) / deviation;
            taps[i] = static_cast<float>(function(x, std::exp(-x * x / 2)));
        }
        return taps;
    }

    template <class T> static double sum(const T& taps) {
        double result = 0;
        for (const float tap : taps) result += tap;
        return result;
    }

    template <class T> static void scale(T& taps, double factor) {
        for (float& tap : taps) tap = static_cast<float>(tap * factor);
    }

    /// Makes positive taps sum to 1 and negative ones to -1.
    static void balance(Detector& taps) {
        double positive = 0, negative = 0;
        for (const float tap : taps) (tap > 0 ? positive : negative) += std::abs(tap);
        for (float& tap : taps) tap = static_cast<float>(tap / (tap > 0 ? positive : negative));
    }
};

/// A tile under a filter that is the product of one along each axis.
template <size_t COUNT>
[[gnu::always_inline]] inline void convolve(const PaddedPlane& plane, const std::array<float, COUNT>& alongX,
                                            const std::array<float, COUNT>& alongY, Plane& result) {
    constexpr size_t MARGIN = HALO - COUNT / 2;
    std::array<float, TILE * PADDED> rows;
    // A row of TILE sums, each over neighbours that are `stride` apart, from `first` on.
    const auto sumRow = [](const float* first, size_t stride, const std::array<float, COUNT>& taps, float* row)
        __attribute__((always_inline)) {
        constexpr size_t AT_ONCE = 32; // sums that stay in registers
        for (size_t begin = 0; begin < TILE; begin += AT_ONCE) {
            std::array<float, AT_ONCE> sums{};
            for (size_t k = 0; k < COUNT; ++k)
                for (size_t x = 0; x < AT_ONCE; ++x) sums[x] += taps[k] * first[k * stride + begin + x];
            for (size_t x = 0; x < AT_ONCE; ++x) row[begin + x] = sums[x];
        }
    };
    for (size_t y = MARGIN; y < PADDED - MARGIN; ++y) sumRow(&plane[y * PADDED + MARGIN], 1, alongX, &rows[y * TILE]);
    for (size_t y = 0; y < TILE; ++y) sumRow(&rows[(y + MARGIN) * TILE], TILE, alongY, &result[y * TILE]);
}

} // namespace vkpm
