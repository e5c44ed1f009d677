/// In what order the passes of a render are added up, so that every way to split it gives the same bits.
#pragma once
#include "shared.h"
#include <cstddef>

namespace vkpm {

/// Passes form a tree: four siblings to a parent, each sum that of its children from left to right. A run is the sum of
/// the first one, two or three children of a node. Joins the run `b` to the run `a` if b is the child that comes next; which
/// runs remain of a range of passes then depends on the range alone, not on the order of joining.
bool joins(PassRange a, PassRange b);

/// The most runs that a film of the passes from 0 on holds at a time; a pass that joins the last run needs none of its own.
std::size_t mostRuns(uint passes);

} // namespace vkpm
