/// Gather radii: the only physics on the host.
#pragma once
#include "scene/scene.h"
#include <span>
#include <string_view>

namespace vkpm {

/// How large a scene is to its light.
struct Extent {
    double diagonal; // of its bounding box,
    double reach;    // greatest coordinate,
    double area;     // of its surfaces, in its own units
    double unit = 1; // of lengths, in world units
};

/// The extent of a scene's shapes.
Extent extentOf(const Scene& scene);

/// That of a scene, or what a box about 98 of 100 places of photons suggests, if that is less: a horizon or a planet
/// far beyond the light must not decide radii.
Extent extentOf(const Extent& scene, std::span<const vec3> places);

/// The widest first radius that the program chooses by itself: a fiftieth of the scene, less if there are many
/// photons, or, where the k nearest of them are sought (nearest > 0), wide enough to hold them almost everywhere.
float widestRadius(const Extent& extent, uint photons, uint nearest);

/// Whether a radius is so small that roundings of coordinates would fill its disc.
bool drownsInRounding(const Extent& extent, float radius);

/// Throws InputError, with the name of what was given, if a radius drowns in rounding.
void requireRadius(const Extent& extent, float radius, std::string_view name);

/// How often the grid's cells may be split before the rounding of the scene's coordinates shows in them.
uint maxLevels(const Extent& extent, float radius);

/// The gather radius of a pass over that of pass 0, so that noise and bias both vanish for alpha in (0, 1); 1 for
/// alpha = 1: the closed form of r(i+1)^2 = r(i)^2 (i + alpha) / (i + 1), i from 1 (Knaus & Zwicker 2011, eq. 16).
float radiusFactor(uint pass, float alpha);

} // namespace vkpm
