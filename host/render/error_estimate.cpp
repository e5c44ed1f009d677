/// Noise and bias of pixels, put together.
#include "render/error_estimate.h"
#include "scene/luminance.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <vector>

namespace vkpm {
namespace {

using glm::dvec3;

const uint parts = 8; // of the picture, along each side

// Quantiles of the normal distribution: one side for the margin of the error, two sides for intervals.
const double oneSided90 = 1.2816, twoSided90 = 1.6449;

dvec3 exactBeauty(const Pixel& pixel) {
    dvec3 sum{0};
    for (const vec3& layer : pixel.mean.layers) sum += dvec3(layer);
    return sum;
}

double meanOf(const dvec3& v) { return (v.x + v.y + v.z) / 3; }

/// Squares over those of the truth, as relmse has them.
double relative(const dvec3& squares, const dvec3& truth) { return meanOf(squares / (truth * truth + 0.01)); }

const uint truthReach = 2; // pixels around

/// What a pixel shows, drawn towards the mean of the 5 x 5 pixels around it, the more so the noisier it is compared to
/// how these differ: the mean of two normal distributions' product (Bishop 2006, eq. 2.141).
dvec3 likelyTruth(const std::vector<dvec3>& colors, const Pixel& pixel, uvec2 size, uint x, uint y) {
    const uint reach = truthReach;
    dvec3 sum{0}, squares{0};
    double count = 0;
    for (uint row = y - std::min(y, reach); row <= std::min(y + reach, size.y - 1); row++)
        for (uint column = x - std::min(x, reach); column <= std::min(x + reach, size.x - 1); column++) {
            if (row == y && column == x) continue;
            const dvec3& color = colors[std::size_t(row) * size.x + column];
            sum += color;
            squares += color * color;
            count++;
        }
    const dvec3& own = colors[std::size_t(y) * size.x + x];
    const dvec3 noise = dvec3(pixel.noise) * dvec3(pixel.noise);
    if (count == 0) return own;
    const dvec3 mean = sum / count;
    const dvec3 spread = glm::max(squares / count - mean * mean, dvec3(1e-12));
    return (own * spread + mean * noise) / (spread + noise);
}

/// The square of the bias of the luminance, less the part of it that is noise of its estimate: may be negative, so that
/// means of it are right.
double squaredBias(const Pixel& pixel) {
    const double bias = luminance(dvec3(pixel.mean.bias)), noise = pixel.biasNoise;
    return bias * bias - noise * noise;
}

/// Two-sided 90 % quantile of Student's t (Cornish & Fisher 1937, by four terms; Abramowitz & Stegun 26.7.5).
double studentQuantile(uint freedom) {
    const std::array<double, 4> few{0, 6.3138, 2.9200, 2.3534}; // the expansion is for more
    if (freedom < few.size()) return few[freedom];
    const double z = twoSided90, n = freedom;
    const double z2 = z * z;
    return z + z * (z2 + 1) / (4 * n) + z * ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
           z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

struct Squares {
    double noise = 0;
    double bias = 0;
};

struct ErrorSums : Squares {
    double count = 0;
    double variance = 0; // of the sum of squared errors
};

double rootOfMean(double sum, double count) { return std::sqrt(std::max(0.0, sum / count)); }

} // namespace

ErrorEstimate estimateError(std::span<const Pixel> pixels, uvec2 size) {
    return estimateError(
        [&](uint firstRow, uint rows) {
        const auto part = pixels.subspan(std::size_t(firstRow) * size.x, std::size_t(rows) * size.x);
        return std::vector<Pixel>(part.begin(), part.end());
        },
        size);
}

/// Squared errors of the pixels of some rows.
static void squaresOf(const std::function<std::vector<Pixel>(uint, uint)>& source, uvec2 size, uint firstRow, uint rows,
                      Squares* squares) {
    const uint first = firstRow - std::min(firstRow, truthReach), end = std::min(firstRow + rows + truthReach, size.y);
    const std::vector<Pixel> pixels = source(first, end - first);
    std::vector<dvec3> colors;
    for (const Pixel& pixel : pixels) colors.push_back(exactBeauty(pixel));
    for (uint y = firstRow - first; y < firstRow + rows - first; y++)
        for (uint x = 0; x < size.x; x++) {
            const Pixel& pixel = pixels[std::size_t(y) * size.x + x];
            const dvec3 truth = likelyTruth(colors, pixel, {size.x, end - first}, x, y);
            *squares++ = {relative(dvec3(pixel.noise) * dvec3(pixel.noise), truth),
                          squaredBias(pixel) / (luminance(truth) * luminance(truth) + 0.01)};
        }
}

ErrorEstimate estimateError(const std::function<std::vector<Pixel>(uint, uint)>& rows, uvec2 size) {
    std::vector<Squares> pixels(std::size_t(size.x) * size.y);
    const uint rowsAtOnce = 32;
    tbb::parallel_for(0u, (size.y + rowsAtOnce - 1) / rowsAtOnce, [&](uint block) {
        const uint row = block * rowsAtOnce;
        squaresOf(rows, size, row, std::min(rowsAtOnce, size.y - row), pixels.data() + std::size_t(row) * size.x);
    });
    std::array<ErrorSums, parts * parts> blocks{};
    ErrorSums all;
    for (std::size_t i = 0; i < pixels.size(); i++) {
        const uint x = static_cast<uint>(i % size.x), y = static_cast<uint>(i / size.x);
        all.variance += 2 * pixels[i].noise * pixels[i].noise;
        for (ErrorSums* sum : {&blocks[y * parts / size.y * parts + x * parts / size.x], &all}) {
            sum->noise += pixels[i].noise;
            sum->bias += pixels[i].bias;
            sum->count++;
        }
    }
    const ErrorEstimate parts{.noise = rootOfMean(all.noise, all.count), .bias = rootOfMean(all.bias, all.count)};
    const double square = parts.noise * parts.noise + parts.bias * parts.bias;

    // Variance of the mean of blocks, each by the pixels that it has.
    double spread = 0, used = 0;
    for (const ErrorSums& block : blocks) {
        if (block.count == 0) continue;
        const double apart = (block.noise + block.bias) - square * block.count;
        spread += apart * apart;
        used++;
    }
    const double parting = used > 1 ? spread * used / (used - 1) : 0;
    const double margin = oneSided90 * std::sqrt(parting + all.variance) / all.count;
    return {parts.noise, parts.bias, std::sqrt(square + margin)};
}

vec3 halfInterval(const Pixel& pixel, uint freedom) {
    const double t = studentQuantile(freedom);
    const dvec3 noise(pixel.noise);
    const dvec3 color = exactBeauty(pixel);
    const dvec3 share = luminance(color) > 0 ? color / luminance(color) : dvec3(1); // channels are off in proportion
    return vec3(glm::sqrt(noise * noise + share * share * std::max(squaredBias(pixel), 0.0)) * t);
}

std::string describe(const ErrorEstimate& e) {
    return fmt::format("error {:.2g} % (noise {:.2g} %, bias {:.2g} %), 90 % sure", 100 * e.error, 100 * e.noise,
                       100 * e.bias);
}

} // namespace vkpm
