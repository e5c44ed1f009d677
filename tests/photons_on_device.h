/// Photon maps for shader tests.
#pragma once
#include "judge.h"
#include "map.h"
#include "render/photon_grid.h"
#include "shared_camera.h"
#include "shared_photons.h"

namespace vkpm {

// Octahedral codes of +z and -z: both coordinates in the middle, or at their ends.
inline constexpr uint normalUp = 32767u | 32767u << 16;
inline constexpr uint normalDown = 65534u | 65534u << 16;

/// Photons sorted into a grid, and the map that kernels read.
class TestMap {
public:
    TestMap(const std::vector<Photon>& photons, float radius, uint levels = 1)
        : grid(testGpu(), "test"), buffer(testGpu(), "test photons", std::max<std::size_t>(photons.size(), 1)) {
        buffer.upload(photons);
        map = grid.build(buffer, static_cast<uint>(photons.size()), radius, 1, levels);
    }

    MapContext context() const { return {.photons = map}; }

private:
    PhotonGrid grid;
    Buffer<Photon> buffer;

public:
    PhotonMap map;
};

inline Query queryAt(vec3 position, uint nearest = 0, vec3 normal = {0, 0, 1}) {
    return {
        .position = position, .normal = normal, .weight = vec3(1), .column = nearest, .footprint = 0, .primitive = 0};
}

/// Squared distance of a photon if it counts for a query (see density.glsl), or infinity; in double precision.
inline double distance2(const Photon& photon, const Query& query, double radius) {
    const glm::dvec3 d = glm::dvec3(photon.position) - glm::dvec3(query.position);
    const double result = glm::dot(d, d), up = photon.normal == normalUp ? 1 : photon.normal == normalDown ? -1 : 0;
    const bool counts = result < radius * radius && std::abs(glm::dot(d, glm::dvec3(query.normal))) <= 0.1 * radius &&
                        up * double{query.normal.z} > 0.5;
    return counts ? result : INFINITY;
}

} // namespace vkpm
