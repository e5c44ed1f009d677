/// Gather radii: the only physics on the host.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// The widest first radius that the program chooses by itself, world units: a fiftieth of the scene, less if there are many
/// photons, or, where the k nearest of them are sought (nearest > 0), wide enough to hold them almost everywhere.
float widestRadius(const Scene& scene, uint photons, uint nearest);

/// How often the grid's cells may be split before the rounding of the scene's coordinates shows in them.
uint mostLevels(const Scene& scene, float radius);

/// The gather radius of a pass over that of pass 0, so that noise and bias both vanish for alpha in (0, 1); 1 for
/// alpha = 1: the closed form of r(i+1)^2 = r(i)^2 (i + alpha) / (i + 1), i from 1 (Knaus & Zwicker 2011, eq. 16).
float radiusFactor(uint pass, float alpha);

} // namespace vkpm
