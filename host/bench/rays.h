/// Rays of the benchmark: the same for vkpm and for Embree, and the same each time.
#pragma once
#include "bench/embree_scene.h"
#include "bench/measure.h"
#include "shared_camera.h"
#include "shared_paths.h"

namespace vkpm {

/// One primary ray per pixel, and from each point that they hit a diffuse bounce and a ray to a light.
struct BenchRays {
    std::vector<Path> primary;
    std::vector<Path> bounce;
    std::vector<ShadowRay> shadow;
};

/// The rays of a scene's camera for a film of the scene's size. Throws InputError if the camera sees nothing.
BenchRays makeRays(const Scene& scene, const EmbreeScene& embree);

/// Rays per second of the trace and shadow kernels, against rtcIntersect1 and rtcOccluded1 on all threads.
std::vector<Measurement> measureRays(Gpu& gpu, const Scene& scene);

} // namespace vkpm
