/// The speed of rays: the kernels of a render beside Embree's queries for single rays.
#include "bench/rays.h"
#include "bench/whole_queue.h"
#include "gpu/recording.h"
#include "render/features.h"
#include "render/uploaded_scene.h"
#include <tbb/parallel_for.h>

namespace vkpm {
namespace {

template <class Work> void forEachRay(std::size_t count, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); i++) work(i);
    });
}

Measurement measureClosest(Gpu& gpu, const Scene& scene, const UploadedScene& uploaded, const EmbreeScene& embree,
                           const std::string& name, const std::vector<Path>& rays) {
    const Buffer<Path> paths(gpu, "bench paths", rays);
    const Buffer<Hit> hits(gpu, "bench hits", rays.size());
    const WholeQueue all(gpu, rays.size());
    const Kernel<TraceArgs> trace(gpu, "trace", sceneFeatures(scene, scene.settings));
    const auto kernel = [&] {
        Recording recording(gpu);
        recording.run(trace, rays.size(), {uploaded.address, paths, hits, all.queue, all.list});
        recording.submit();
    };
    std::vector<Hit> found(rays.size());
    const auto host = [&] {
        forEachRay(rays.size(), [&](std::size_t i) { found[i] = embree.closest(rays[i].origin, rays[i].direction); });
    };
    return asRate(name, "rtcIntersect1", "rays/s", double(rays.size()),
                  measurePairs([&] { return kernelSeconds(gpu, kernel); }, [&] { return wallSeconds(host); }));
}

Measurement measureShadow(Gpu& gpu, const Scene& scene, const UploadedScene& uploaded, const EmbreeScene& embree,
                          const std::vector<ShadowRay>& rays) {
    const Buffer<ShadowRay> shadowRays(gpu, "bench shadow rays", rays);
    const Buffer<float> samples(gpu, "bench samples", 3 * rays.size());
    const WholeQueue all(gpu, rays.size());
    const Kernel<ShadowArgs> shadow(gpu, "shadow", sceneFeatures(scene, scene.settings));
    const auto kernel = [&] {
        Recording recording(gpu);
        recording.run(shadow, rays.size(),
                      {uploaded.address, shadowRays, samples, all.queue, all.list, static_cast<uint>(rays.size())});
        recording.submit();
    };
    std::vector<vec3> direct(rays.size());
    const auto host = [&] {
        forEachRay(rays.size(), [&](std::size_t i) {
            if (!embree.occluded(rays[i].origin, rays[i].target)) direct[i] += rays[i].radiance;
        });
    };
    return asRate("shadow_rays", "rtcOccluded1", "rays/s", double(rays.size()),
                  measurePairs([&] { return kernelSeconds(gpu, kernel); }, [&] { return wallSeconds(host); }));
}

} // namespace

std::vector<Measurement> measureRays(Gpu& gpu, const Scene& scene) {
    const EmbreeScene embree(scene);
    const BenchRays rays = makeRays(scene, embree);
    const UploadedScene uploaded(gpu, scene, scene.settings);
    return {measureClosest(gpu, scene, uploaded, embree, "primary_rays", rays.primary),
            measureClosest(gpu, scene, uploaded, embree, "bounce_rays", rays.bounce),
            measureShadow(gpu, scene, uploaded, embree, rays.shadow)};
}

} // namespace vkpm
