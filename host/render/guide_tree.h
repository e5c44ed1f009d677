/// Which photons to start: a density over the numbers that start them, learned from some that were started.
#pragma once
#include "shared_photons.h"
#include <array>
#include <span>
#include <vector>

namespace vkpm {

/// A binary tree of boxes over the unit cube of a photon's numbers, see guide.glsl.
struct GuideTree {
    std::vector<GuideNode> nodes; // the first is the root
    double gain = 1;    // variance of uniform photons over that of guided ones in the same time, as far as known,
    double density = 1; // and of as many
};

/// The tree whose photons cause the least variance in a time: each box gets them in proportion to the root of the mean
/// square of what one adds to the picture over the mean of what it costs (Cochran 1977, eq. 5.23). It adds its weight
/// if the eye sees where it is stored (Grittmann et al. 2018 call it useful), else nothing. `axes` says which numbers
/// matter in a scene.
GuideTree guideTree(std::span<const PrimarySample> starts, const std::array<bool, PRIMARY_DIMENSIONS>& axes);

} // namespace vkpm
