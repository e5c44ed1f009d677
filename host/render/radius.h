/// Gather radii: the only physics on the host.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// The settings with radii (world units) for the gathers where none are given: discs that hold a few photons each on the
/// average, so that radii shrink with the square root of the photons' number.
Settings chooseRadii(const Scene& scene, Settings settings);

} // namespace vkpm
