/// Polygons cut into triangles.
#pragma once
#include "shared.h"
#include <array>
#include <span>
#include <vector>

namespace vkpm {

const std::size_t maxCorners = 20'000; // of a polygon in a file: to cut the worst takes seconds

/// Triangles of the corners' indices, in the polygon's winding, always two fewer than corners: a quad is cut along its
/// shorter diagonal, unless only the other one lies inside; others by clipping ears (Meisters 1975) in the plane that
/// the polygon spans most of, and where there is none, since it crosses itself, as a fan.
std::vector<std::array<uint, 3>> triangulate(std::span<const glm::dvec3> polygon);

} // namespace vkpm
