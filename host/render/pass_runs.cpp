/// Which runs of passes may be added.
#include "render/pass_runs.h"
#include "shared_film.h"
#include <algorithm>
#include <vector>

namespace vkpm {

const std::uint64_t siblings = 4;

bool joins(PassRange a, PassRange b) {
    if (a.end != b.begin) return false;
    const std::uint64_t child = b.end - b.begin;
    std::uint64_t node = 1;
    while (node < child) node *= siblings;
    const std::uint64_t before = a.end - a.begin;
    return node == child && b.begin % child == 0 && a.begin % (siblings * child) == 0 && before % child == 0 &&
           before < siblings * child;
}

std::size_t maxRuns(uint passes) {
    std::vector<PassRange> runs;
    std::size_t most = 0;
    for (uint pass = 0; pass < std::min(passes, 1u << 20); pass++) {
        if (!runs.empty() && joins(runs.back(), {pass, pass + 1})) runs.back().end++;
        else runs.push_back({pass, pass + 1});
        most = std::max(most, runs.size());
        while (runs.size() > 1 && joins(runs[runs.size() - 2], runs.back())) {
            runs[runs.size() - 2].end = runs.back().end;
            runs.pop_back();
        }
    }
    return most;
}

JoinWeights joinWeights(PassRange a, PassRange b) {
    const float m = static_cast<float>(length(a)), n = static_cast<float>(length(b));
    const float batches = m / (m + n); // m n / (m + n), in batches of n passes
    return {.perPass = m > 0 ? 1 / m : 0,
            .times = length(a) / length(b),
            .fine = n > 1 ? float(siblings) * batches : 0,
            .coarse = batches,
            .grows = length(a) == length(b)};
}

/// The greatest node of the tree that has no more passes.
static uint nodeWithin(uint passes) {
    std::uint64_t node = 1;
    while (siblings * node <= passes) node *= siblings;
    return static_cast<uint>(node);
}

uint coarseBatch(PassRange run) {
    const uint node = nodeWithin(length(run));
    return node == length(run) ? std::max<uint>(node / siblings, 1) : node;
}

uint greatestBatch(std::span<const PassRange> runs) {
    return coarseBatch(*std::ranges::max_element(runs, {}, [](PassRange run) { return length(run); }));
}

Batches batchesOf(std::span<const PassRange> runs, uint size) {
    Batches batches{size, 0, 0};
    for (const PassRange run : runs) {
        batches.count += std::max(length(run) / size, 1u);
        batches.weight += double(length(run)) / size;
    }
    return batches;
}

} // namespace vkpm
