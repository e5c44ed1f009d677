/// What photons of the caustic map are aimed at: spheres around specular shapes and parts of them.
#pragma once
#include "shared.h"
#include <array>
#include <span>
#include <vector>

namespace vkpm {

using TrianglePoints = std::array<vec3, 3>;

/// Spheres that enclose the triangles of each shape, every triangle in one of them: one for each shape, then parts of those
/// that most lines through them would miss, up to `most` in all. Reorders the triangles.
std::vector<Target> targetsAround(std::span<const std::span<TrianglePoints>> shapes, std::size_t most);

} // namespace vkpm
