/// Noise and bias of pixels, put together.
#include "render/error_estimate.h"
#include "render/noise.h"
#include "scene/luminance.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <tbb/parallel_for.h>
#include <vector>

namespace vkpm {
namespace {

using glm::dvec3;

const uint parts = 8; // of the picture, along each side

// What the estimates themselves may be off, as factors: measured on the shipped scenes (tools/study truth).
const double noiseUnsure = 1.1, biasUnsure = 1.25;

// Quantiles of the normal distribution: one side for the margin of the error, two sides for intervals.
const double oneSided90 = 1.2816, twoSided90 = 1.6449;

dvec3 exactBeauty(const Pixel& pixel) {
    dvec3 sum{0};
    for (const vec3& layer : pixel.mean.layers) sum += dvec3(layer);
    return sum;
}

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

/// Squared relative errors of a pixel.
struct Squares {
    vec3 noise{0};
    float bias = 0; // of the luminance; may be negative, see squaredBias
};

/// The squared error of a value, whose expectation is `square`, if it is among those that are off least: the
/// probability that it is, and the part of the expectation from there, if the error is normally distributed.
struct KeptSquare {
    double probability;
    double part;
};

KeptSquare keptSquare(double square, double greatest) {
    if (square <= 0) return {1, 1};
    const double reach = std::sqrt(greatest / square), inside = std::erf(reach / std::numbers::sqrt2);
    return {inside, inside - reach * std::sqrt(2 / std::numbers::pi) * std::exp(-0.5 * reach * reach)};
}

/// The squared error that KEPT of the values are not expected to exceed; `expectedOf` gives the expectations of pixels.
template <class Expected> double greatestKept(std::size_t pixels, Expected expectedOf) {
    const int least = -64, most = 64, each = 32; // octaves, and parts of each
    std::vector<double> counts(std::size_t((most - least) * each), 0);
    for (std::size_t i = 0; i < pixels; i++) {
        const dvec3 squares = expectedOf(i);
        for (int c = 0; c < 3; c++)
            if (squares[c] > 0) // others are kept
                counts[std::size_t(
                    std::clamp((std::log2(squares[c]) - least) * each, 0.0, double(counts.size() - 1)))]++;
    }
    const double left = (1 - KEPT) * 3 * double(pixels);
    double low = least, high = most + 8;
    for (int step = 0; step < 50; step++) {
        const double middle = (low + high) / 2;
        double above = 0;
        for (std::size_t i = 0; i < counts.size(); i++)
            if (counts[i] > 0)
                above += counts[i] *
                         std::erfc(std::exp2((middle - least - (double(i) + 0.5) / each) / 2) / std::numbers::sqrt2);
        (above > left ? low : high) = middle;
    }
    return std::exp2(high);
}

/// What values are expected to be off, all of them or those that are off least.
struct ErrorSums {
    double noise = 0, bias = 0;
    double count = 0;
    double variance = 0; // of the sum of squared errors, if the colours of a pixel are off together

    void add(const Squares& pixel, const std::array<KeptSquare, 3>& kept) {
        double square = 0;
        for (uint c = 0; c < 3; c++) {
            square += kept[c].part * double{pixel.noise[int(c)]};
            bias += kept[c].part * double{pixel.bias};
            count += kept[c].probability;
        }
        noise += square;
        variance += 2 * square * square;
    }
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
            *squares++ = {vec3(dvec3(pixel.noise) * dvec3(pixel.noise) / (truth * truth + 0.01)),
                          float(squaredBias(pixel) / (luminance(truth) * luminance(truth) + 0.01))};
        }
}

ErrorEstimate estimateError(const std::function<std::vector<Pixel>(uint, uint)>& rows, uvec2 size) {
    std::vector<Squares> pixels(std::size_t(size.x) * size.y);
    const uint rowsAtOnce = 32;
    tbb::parallel_for(0u, (size.y + rowsAtOnce - 1) / rowsAtOnce, [&](uint block) {
        const uint row = block * rowsAtOnce;
        squaresOf(rows, size, row, std::min(rowsAtOnce, size.y - row), pixels.data() + std::size_t(row) * size.x);
    });
    // A single pixel's bias is noisy, and what is noisy must not choose.
    std::vector<double> around;
    around.reserve(pixels.size());
    for (const Squares& pixel : pixels) around.push_back(double{pixel.bias});
    around = sumsAround(around, size);
    const auto reached = [](uint at, uint all) {
        return std::min(at + noiseReach, all - 1) - (at - std::min<uint>(at, noiseReach)) + 1;
    };
    const auto expectedOf = [&](std::size_t i) {
        const uint count = reached(uint(i % size.x), size.x) * reached(uint(i / size.x), size.y);
        return dvec3(pixels[i].noise) + std::fmax(around[i] / count, 0.0);
    };
    const double greatest = greatestKept(pixels.size(), expectedOf);

    std::array<ErrorSums, parts * parts> blocks{};
    ErrorSums all, whole;
    std::uint64_t specks = 0;
    for (std::size_t i = 0; i < pixels.size(); i++) {
        const dvec3 expected = expectedOf(i);
        const std::array kept{keptSquare(expected.x, greatest), keptSquare(expected.y, greatest),
                              keptSquare(expected.z, greatest)};
        const uint x = static_cast<uint>(i % size.x), y = static_cast<uint>(i / size.x);
        blocks[y * parts / size.y * parts + x * parts / size.x].add(pixels[i], kept);
        all.add(pixels[i], kept);
        whole.add(pixels[i], {{{1, 1}, {1, 1}, {1, 1}}});
        specks += pixels[i].noise.x + pixels[i].noise.y + pixels[i].noise.z > 3;
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
    const auto between = [&](double noise, double bias) {
        return noise * noise * parts.noise * parts.noise + bias * bias * parts.bias * parts.bias;
    };
    return {.noise = parts.noise,
            .bias = parts.bias,
            .error = std::sqrt(between(noiseUnsure, biasUnsure) + margin),
            .least = std::sqrt(std::max(between(1 / noiseUnsure, 1 / biasUnsure) - margin, 0.0)),
            .whole = rootOfMean(whole.noise + whole.bias, whole.count),
            .specks = specks};
}

std::vector<bool> keptValues(std::span<const float> squares) {
    std::vector<bool> kept(squares.size(), true);
    const auto left = std::size_t(double(squares.size()) * (1 - KEPT));
    if (left == 0) return kept;
    std::vector<float> sorted(squares.begin(), squares.end());
    const auto last = sorted.end() - std::ptrdiff_t(left) - 1; // of those that are kept
    std::ranges::nth_element(sorted, last);
    std::size_t equal = std::size_t(std::count(sorted.begin(), last + 1, *last)); // of these, the first are kept
    for (std::size_t i = 0; i < squares.size(); i++)
        kept[i] = squares[i] < *last || (squares[i] == *last && equal > 0 && equal-- > 0);
    return kept;
}

/// Two-sided 90 % quantile of Student's t (Cornish & Fisher 1937, by four terms; Abramowitz & Stegun 26.7.5).
double intervalQuantile(uint freedom) {
    const std::array<double, 4> few{0, 6.3138, 2.9200, 2.3534}; // the expansion is for more
    if (freedom < few.size()) return few[freedom];
    const double z = twoSided90, n = freedom;
    const double z2 = z * z;
    return z + z * (z2 + 1) / (4 * n) + z * ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
           z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

vec3 halfInterval(const Pixel& pixel, uint freedom) {
    const double t = intervalQuantile(freedom);
    const dvec3 noise(pixel.noise);
    const dvec3 color = exactBeauty(pixel);
    const dvec3 share = luminance(color) > 0 ? color / luminance(color) : dvec3(1); // channels are off in proportion
    return vec3(glm::sqrt(noise * noise + share * share * std::max(squaredBias(pixel), 0.0)) * t);
}

std::string describe(const ErrorEstimate& e) {
    return fmt::format(
        "error {:.2g} % (noise {:.2g} %, bias {:.2g} %), 90 % sure, without the worst {:.0f} % ({} specks)",
        100 * e.error, 100 * e.noise, 100 * e.bias, 100 * (1 - KEPT), e.specks);
}

} // namespace vkpm
