/// How far the mean of passes may be from its expectation, by how batches of passes differ.
#pragma once
#include "render/pass_runs.h"
#include "shared_film.h"
#include <vector>

namespace vkpm {

/// Pixels around one that its noise depends on, to all sides.
const int noiseReach = 3;

/// Variances of the mean of a pixel as batches of two sizes tell it, as if batches were independent; 0 with a single
/// batch.
struct Spread {
    glm::dvec3 coarse{0}; // of batches of greatestBatch() passes
    glm::dvec3 fine{0};   // of a quarter of that; 0 if that is less than a pass
};

/// Adds up the deviations of one pixel over runs of passes.
class SpreadSum {
public:
    /// `fine` and `coarse` as in PixelSum; `sum` is the sum of the run's samples.
    void add(PassRange run, uint size, const glm::dvec3& sum, const glm::dvec3& fine, const glm::dvec3& coarse);
    /// The variance of the mean over all.
    glm::dvec3 variance(const Batches& batches) const;

private:
    glm::dvec3 mean{0};
    glm::dvec3 deviation{0}; // with batches as weights
    double weight = 0;
};

/// Sums of a value over the pixels within reach of each one.
std::vector<double> sumsAround(const std::vector<double>& values, uvec2 size);

/// Standard errors of the means of pixels from their spreads, row by row. Points of a low-discrepancy sequence
/// complement each other: the larger a batch, the better its mean, compared to independent points. How much is measured
/// from fine to coarse batches in the 7 x 7 pixels around, and supposed to go on, if less, from coarse batches to the
/// whole.
std::vector<vec3> noiseOf(const std::vector<Spread>& spreads, uvec2 size, std::span<const PassRange> runs);

/// Degrees of freedom of these errors; 0 if there is no estimate. An interval of Student's t with as many covers the
/// expectation as often as it says.
uint noiseFreedom(std::span<const PassRange> runs);

} // namespace vkpm
