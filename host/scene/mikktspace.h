/// Tangents of meshes that bring none, as programs that bake normal maps compute them.
#pragma once
#include "scene/mesh.h"
#include <vector>

namespace vkpm {

/// Of all triangles: at each corner the direction in which u of a set of coordinates grows, across the normal and of
/// unit length, and the side of v; 0 for triangles that are flat, or whose coordinates span no area. Corners of one
/// place, normal and coordinates, in a fan of triangles of one orientation, share one, weighted by angle. Source:
/// Mikkelsen 2008, Simulation of Wrinkled Surfaces Revisited, as the space of tangents that glTF 2.0 asks for,
/// section 3.7.2.1.
std::vector<Tangents> mikkTangents(const Mesh& mesh, std::size_t set);

} // namespace vkpm
