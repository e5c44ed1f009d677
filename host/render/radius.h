/// Gather radii: the only physics on the host.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// The settings with radii (world units) for the gathers where none are given: discs that hold a few photons each on the
/// average, so that radii shrink with the square root of the photons' number.
Settings chooseRadii(const Scene& scene, Settings settings);

/// The gather radius of a pass over that of pass 0, so that noise and bias both vanish for alpha in (0, 1); 1 for
/// alpha = 1: the closed form of r(i+1)^2 = r(i)^2 (i + alpha) / (i + 1), i from 1 (Knaus & Zwicker 2011, eq. 16).
float radiusFactor(uint pass, float alpha);

} // namespace vkpm
