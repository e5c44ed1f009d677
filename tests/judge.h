/// Judging arrays: random numbers with fixed seeds, chi-square, and means with their standard errors.
#pragma once
#include "shared.h"
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace vkpm {

inline constexpr double pi = std::numbers::pi;

/// Numbers on the host that do not depend on the standard library's distributions.
class Random {
public:
    explicit Random(uint seed) : engine(seed) {}
    uint bits() { return static_cast<uint>(engine()); }
    /// Uniform in [0, 1), 24 bits.
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * unit(); }
    vec2 unit2() { return vec2{unit(), unit()}; }
    vec3 cube(float half) { return vec3{between(-half, half), between(-half, half), between(-half, half)}; }
    /// Uniform over the sphere, rounded to float from double.
    vec3 direction() {
        const double z = 2 * double{unit()} - 1, phi = 2 * pi * double{unit()}, r = std::sqrt(1 - z * z);
        return vec3{glm::dvec3{r * std::cos(phi), r * std::sin(phi), z}};
    }

private:
    std::mt19937 engine;
};

inline std::vector<vec2> unitSquare(uint count, uint seed) {
    Random random(seed);
    std::vector<vec2> points(count);
    for (vec2& point : points) point = random.unit2();
    return points;
}

/// Counts over bins of equal probability.
class Histogram {
public:
    Histogram(int columns, int rows) : width(columns), height(rows), counts(static_cast<std::size_t>(columns * rows)) {}

    /// Counts a point of the unit square; its upper ends belong to the last bins.
    void add(double x, double y) {
        outside += x < -1e-5 || x > 1 + 1e-5 || y < -1e-5 || y > 1 + 1e-5 || std::isnan(x) || std::isnan(y);
        addBin(bin(x, width) + width * bin(y, height));
    }
    void addBin(int i) {
        counts[static_cast<std::size_t>(i)]++;
        total++;
    }
    /// How many standard deviations chi-square lies above its mean (Wilson & Hilferty 1931); infinite if a point was
    /// outside.
    double deviation() const {
        const double expected = total / double(counts.size()), freedom = double(counts.size()) - 1;
        double sum = 0;
        for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
        const double spread = 2 / (9 * freedom);
        return outside > 0 ? INFINITY : (std::cbrt(sum / freedom) - 1 + spread) / std::sqrt(spread);
    }

private:
    static int bin(double x, int bins) {
        return std::isnan(x) ? 0 : std::min(std::max(static_cast<int>(x * bins), 0), bins - 1);
    }

    int width, height;
    std::vector<double> counts;
    double total = 0;
    int outside = 0;
};

/// The mean of samples and its standard error.
class Mean {
public:
    void add(double x) {
        count++;
        const double before = x - value;
        value += before / count;
        squares += before * (x - value);
    }
    double mean() const { return value; }
    double deviation() const { return std::sqrt(squares / (count - 1)); }
    double error() const { return deviation() / std::sqrt(count); }

private:
    double count = 0, value = 0, squares = 0;
};

/// The angle of (x, y) as a fraction of a turn, in [0, 1).
inline double turn(double x, double y) {
    const double angle = std::atan2(y, x) / (2 * pi);
    return angle < 0 ? angle + 1 : angle;
}

} // namespace vkpm
