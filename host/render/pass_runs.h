/// In what order the passes of a render are added up, so that every way to split it gives the same bits.
#pragma once
#include "shared_film.h"
#include <cstddef>
#include <span>

namespace vkpm {

inline uint length(PassRange passes) { return passes.end - passes.begin; }

/// Passes form a tree: four siblings to a parent, each sum that of its children from left to right. A run is the sum of
/// the first one, two or three children of a node. Joins the run `b` to the run `a` if b is the child that comes next;
/// which runs remain of a range of passes then depends on the range alone, not on the order of joining.
bool joins(PassRange a, PassRange b);

/// The most runs that a film of the passes from 0 on holds at a time; a pass that joins the last run needs none of its
/// own.
std::size_t maxRuns(uint passes);

/// How to join b, or its first passes, to a, which may be empty.
JoinWeights joinWeights(PassRange a, PassRange b);

/// Passes of the batches that a run's deviations of large batches are about; its small batches have a quarter.
uint coarseBatch(PassRange run);

/// Batches of passes by which the spread of a mean over runs of passes is judged: runs are cut into whole ones, with a
/// part of one for a run that is less.
struct Batches {
    uint size;     // passes in a batch, a power of four
    uint count;    // with parts
    double weight; // passes over size
};
Batches batchesOf(std::span<const PassRange> runs, uint size);

/// The greatest size of batches for which runs have deviations; a quarter of that is the other one, if it is 1 or more.
uint greatestBatch(std::span<const PassRange> runs);

} // namespace vkpm
