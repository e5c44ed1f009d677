/// Variance by batches, and what low-discrepancy points make of it.
#include "render/noise.h"
#include "shared_film.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

using glm::dvec3;

/// Of the gain from fine to coarse batches, in its logarithm, what goes on from batches of some passes to the whole:
/// measured on the shipped scenes (tools/study truth), where larger batches gain less and less from their points.
static double lastingGain(double batch, double whole) {
    const double few = 16, tillFew = 0.75, beyond = 0.5; // passes; parts for each factor of four
    const auto steps = [](double from, double to) { return std::log(to / from) / std::log(4.0); };
    return tillFew * steps(std::min(batch, few), std::min(whole, few)) +
           beyond * steps(std::max(batch, few), std::max(whole, few));
}

void SpreadSum::add(PassRange run, uint size, const dvec3& sum, const dvec3& fine, const dvec3& coarse) {
    const double w = double(length(run)) / size;
    const dvec3 apart = sum / double(length(run)) - mean;
    if (length(run) > size) deviation += coarseBatch(run) == size ? coarse : fine;
    deviation += apart * apart * (weight * w / (weight + w));
    weight += w;
    mean += apart * (w / weight);
}

dvec3 SpreadSum::variance(const Batches& batches) const {
    return batches.count < 2 ? dvec3(0) : deviation / (batches.count - 1.0) / batches.weight;
}

namespace {

struct Levels {
    Batches coarse;
    Batches fine; // no count: there is none
};

Levels levelsOf(std::span<const PassRange> runs) {
    const uint size = greatestBatch(runs);
    return {batchesOf(runs, size), size >= 4 ? batchesOf(runs, size / 4) : Batches{}};
}

double total(const dvec3& v) { return v.x + v.y + v.z; }

} // namespace

std::vector<double> sumsAround(const std::vector<double>& values, uvec2 size) {
    const int width = int(size.x), height = int(size.y);
    const auto sum = [&](const std::vector<double>& in, int x, int y, int dx, int dy) {
        double total = 0;
        for (int i = -noiseReach; i <= noiseReach; i++) {
            const int column = x + i * dx, row = y + i * dy;
            if (column >= 0 && column < width && row >= 0 && row < height)
                total += in[std::size_t(row) * size.x + std::size_t(column)];
        }
        return total;
    };
    // By columns, then by rows.
    std::vector<double> rows(values.size()), all(values.size());
    for (int y = 0, i = 0; y < height; y++)
        for (int x = 0; x < width; x++, i++) rows[std::size_t(i)] = sum(values, x, y, 1, 0);
    for (int y = 0, i = 0; y < height; y++)
        for (int x = 0; x < width; x++, i++) all[std::size_t(i)] = sum(rows, x, y, 0, 1);
    return all;
}

std::vector<vec3> noiseOf(const std::vector<Spread>& spreads, uvec2 size, std::span<const PassRange> runs) {
    std::vector<vec3> noise;
    noise.reserve(spreads.size());
    const Levels levels = levelsOf(runs);
    if (levels.fine.count == 0) {
        for (const Spread& spread : spreads) noise.push_back(vec3(glm::sqrt(spread.coarse)));
        return noise;
    }

    std::vector<double> coarse, fine;
    for (const Spread& spread : spreads) {
        coarse.push_back(total(spread.coarse));
        fine.push_back(total(spread.fine));
    }
    coarse = sumsAround(coarse, size);
    fine = sumsAround(fine, size);
    // Batches four times as large: one step. Both sizes count by their degrees of freedom.
    const double lasting = lastingGain(levels.coarse.size, levels.coarse.size * levels.coarse.weight);
    const double a = levels.coarse.count - 1, b = levels.fine.count - 1;
    for (std::size_t i = 0; i < spreads.size(); i++) {
        const double gain = fine[i] > 0 ? std::min(coarse[i] / fine[i], 1.0) : 1;
        const dvec3 variance =
            (a * std::pow(gain, lasting) * spreads[i].coarse + b * std::pow(gain, lasting + 1) * spreads[i].fine) /
            (a + b);
        noise.push_back(vec3(glm::sqrt(variance)));
    }
    return noise;
}

uint noiseFreedom(std::span<const PassRange> runs) {
    if (runs.empty()) return 0;
    const Levels levels = levelsOf(runs);
    return levels.coarse.count - 1 + (levels.fine.count ? levels.fine.count - 1 : 0);
}

} // namespace vkpm
