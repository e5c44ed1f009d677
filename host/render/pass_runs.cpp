/// Which runs of passes may be added.
#include "render/pass_runs.h"
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
    return node == child && b.begin % child == 0 && a.begin % (siblings * child) == 0 && before % child == 0 && before < siblings * child;
}

std::size_t mostRuns(uint passes) {
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

} // namespace vkpm
