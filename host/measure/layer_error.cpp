/// Error measures of a layer, in double precision.
#include "measure/layer_error.h"
#include "measure/flip.h"
#include "render/error_estimate.h"
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkpm {
namespace {

constexpr double NOTHING = std::numeric_limits<double>::quiet_NaN();

bool isFinite(const Layer& layer, size_t pixel) {
    return std::ranges::all_of(layer.channels, [=](const auto& channel) { return std::isfinite(channel[pixel]); });
}

/// Adds one value's errors to their sums, and returns the square of the relative one.
double add(LayerError& sum, double x, double reference) {
    const double error = x - reference, relative = error * error / (reference * reference + 0.01);
    sum.rmse += error * error;
    sum.relmse += relative;
    sum.meanError += error;
    sum.meanRelativeError += std::abs(error) / (std::abs(reference) + 0.01);
    sum.maxError = std::max(sum.maxError, std::abs(error));
    return relative;
}

/// Turns sums over `count` values into what they are the sums of.
void finish(LayerError& error, double count) {
    error.rmse = std::sqrt(error.rmse / count);
    error.relmse /= count;
    error.meanError /= count;
    error.meanRelativeError /= count;
    if (count == 0) error.maxError = NOTHING;
}

double meanFlip(const Layer& image, const Layer& reference) {
    const std::vector<float> map = flipMap(image, reference);
    return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

} // namespace

double keptError(const std::vector<float>& squares) {
    const std::vector<bool> kept = keptValues(squares);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < squares.size(); i++)
        if (kept[i]) sum += double{squares[i]}, count++;
    return std::sqrt(sum / count);
}

LayerError measureLayer(const Layer& image, const Layer& reference) {
    assert(areComparable(image, reference) && image.size == reference.size);
    LayerError error;
    const size_t pixels = image.channels[0].size();
    std::vector<float> squares; // relative
    squares.reserve(pixels * image.channels.size());
    for (size_t i = 0; i < pixels; ++i) {
        if (!isFinite(image, i) || !isFinite(reference, i)) {
            ++error.nonfinite;
            continue;
        }
        for (size_t c = 0; c < image.channels.size(); ++c)
            squares.push_back(static_cast<float>(add(error, image.channels[c][i], reference.channels[c][i])));
    }
    const size_t finite = pixels - error.nonfinite;
    finish(error, static_cast<double>(finite * image.channels.size()));
    error.error = keptError(squares);
    error.flip = image.isColour && finite > 0 ? meanFlip(image, reference) : NOTHING;
    return error;
}

} // namespace vkpm
