/// Sorting photons into cells by counting, and summing those within a disc.
#include "bench/host_grid.h"
#include <glm/gtc/constants.hpp>
#include <numeric>

namespace vkpm {

static constexpr double maxCells = 1u << 22;

HostGrid::HostGrid(const std::vector<SurfacePoint>& unsorted, float gatherRadius) : radius(gatherRadius) {
    vec3 high = low = unsorted.front().position;
    for (const SurfacePoint& photon : unsorted) {
        low = glm::min(low, photon.position);
        high = glm::max(high, photon.position);
    }
    float width = radius;
    const auto cells = [&] { return glm::floor((high - low) / width) + 1.0f; };
    while (double(cells().x) * double(cells().y) * double(cells().z) > maxCells) width *= 1.25f;
    cellsPerUnit = 1 / width;
    size = ivec3(cells());
    sort(unsorted);
}

ivec3 HostGrid::cellOf(vec3 position) const {
    return glm::clamp(ivec3((position - low) * cellsPerUnit), ivec3{0}, size - 1);
}

void HostGrid::sort(const std::vector<SurfacePoint>& unsorted) {
    const auto indexOf = [&](const SurfacePoint& photon) {
        const ivec3 cell = cellOf(photon.position);
        return index(cell.x, cell.y, cell.z);
    };
    starts.assign(std::size_t(size.x) * size.y * size.z + 1, 0);
    for (const SurfacePoint& photon : unsorted) starts[indexOf(photon)]++;
    std::inclusive_scan(starts.begin(), starts.end(), starts.begin());
    photons.resize(unsorted.size());
    for (const SurfacePoint& photon : unsorted) photons[--starts[indexOf(photon)]] = photon;
}

vec3 HostGrid::irradiance(const Query& query) const {
    const ivec3 first = cellOf(query.position - radius), last = cellOf(query.position + radius);
    vec3 sum{0};
    for (int z = first.z; z <= last.z; z++)
        for (int y = first.y; y <= last.y; y++) {
            const std::size_t end = starts[index(last.x, y, z) + 1];
            for (std::size_t i = starts[index(first.x, y, z)]; i < end; i++) {
                const SurfacePoint& photon = photons[i];
                const vec3 d = photon.position - query.position;
                if (glm::dot(d, d) >= radius * radius) continue;
                const bool near = glm::abs(glm::dot(d, query.normal)) <= 0.1f * radius;
                if (near && glm::dot(photon.normal, query.normal) > 0.5f) sum += photon.color;
            }
        }
    return sum / (glm::pi<float>() * radius * radius);
}

} // namespace vkpm
