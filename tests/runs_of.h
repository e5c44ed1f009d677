/// The runs that a film keeps of a range of passes.
#pragma once
#include "render/pass_runs.h"
#include "shared_film.h"
#include <vector>

namespace vkpm {

/// Joins runs from the left as the film does.
inline void append(std::vector<PassRange>& runs, PassRange run) {
    runs.push_back(run);
    while (runs.size() > 1 && joins(runs[runs.size() - 2], runs.back())) {
        runs[runs.size() - 2].end = runs.back().end;
        runs.pop_back();
    }
}

inline std::vector<PassRange> runsOf(PassRange passes) {
    std::vector<PassRange> runs;
    for (uint pass = passes.begin; pass < passes.end; pass++) append(runs, {pass, pass + 1});
    return runs;
}

} // namespace vkpm
