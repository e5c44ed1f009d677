/// Gathers from a photon map, beside a loop over a grid on the host.
#pragma once
#include "bench/host_grid.h"
#include "bench/measure.h"
#include "scene/scene.h"
#include "shared_camera.h"

namespace vkpm {

/// Photons and queries, each uniformly random on the surfaces of a scene and in random order, and the radius of a disc
/// that holds about 20 of the photons.
struct BenchGathers {
    std::vector<SurfacePoint> photons;
    std::vector<Query> queries;
    float radius = 0;
};

/// 2^18 photons and 2^17 queries on a scene's surfaces.
BenchGathers makeGathers(const Scene& scene);

/// Queries per second of the gather kernel with the constant kernel and a fixed radius, against HostGrid on all
/// threads. Throws std::runtime_error if the two find different sums.
Measurement measureGather(Gpu& gpu, const Scene& scene);

} // namespace vkpm
