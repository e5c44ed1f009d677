/// A plain grid of photons on the host: the yardstick of gathers.
#pragma once
#include "shared_camera.h"
#include <vector>

namespace vkpm {

/// A point of a surface, and the colour of the photon that arrived there.
struct SurfacePoint {
    vec3 position;
    vec3 normal;
    vec3 color;
};

/// Photons in the order of the cells of a dense grid over their bounds.
class HostGrid {
public:
    /// Cells are as wide as the radius, or wider where that would make too many.
    HostGrid(const std::vector<SurfacePoint>& photons, float radius);

    /// What the gather kernel finds with the constant kernel and the fixed radius.
    vec3 irradiance(const Query& query) const;

private:
    ivec3 cellOf(vec3 position) const;
    std::size_t index(int x, int y, int z) const { return x + std::size_t(size.x) * (y + std::size_t(size.y) * z); }
    void sort(const std::vector<SurfacePoint>& unsorted);

    float radius;
    float cellsPerUnit = 0;
    vec3 low{0};
    ivec3 size{1};
    std::vector<std::size_t> starts; // by cell, and the end
    std::vector<SurfacePoint> photons;
};

} // namespace vkpm
