/// The camera loop: eye, then trace, shade, shadow and gather until no path is under way.
#include "render/camera_paths.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

const uint maxBounces = 10'000;
const uint bouncesAtOnce = 4; // recorded before the host looks whether any path is left; divides maxBounces

CameraPaths::CameraPaths(Gpu& device, const UploadedScene& uploaded, const Features& has, const Settings& set, uint wave)
    : gpu(device), scene(uploaded), settings(set), features(has), size(std::min(set.size.x * set.size.y, wave)),
      compaction(gpu, "camera", size, EYE_QUEUES), paths(gpu, "camera paths", size), hits(gpu, "camera hits", size),
      eye(gpu, "eye", features), traceKernel(gpu, "trace", features), shade(gpu, "shade", features) {
    samples = Buffer<float>(gpu, "camera samples", std::uint64_t(Columns(features).SAMPLE_COLUMNS) * size);
    if (asksLights(features, settings)) {
        shadowRays = Buffer<ShadowRay>(gpu, "camera shadow rays", size);
        shadow.emplace(gpu, "shadow", features);
    }
    if (asksMaps(features)) {
        queries = Buffer<Query>(gpu, "camera queries", size);
        gather.emplace(gpu, settings.showPoints ? "points" : "gather", features);
    }
    const Camera camera = scene.address.read1().camera;
    pixelAngle = 2 * glm::length(camera.up) / float(settings.size.y);
}

void CameraPaths::bounce(Recording& recording, uint pass, uint first, uint index, const PhotonMaps& maps) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(shade, queues, QUEUE_CONTINUE,
                  {scene.address, paths, hits, samples, shadowRays, queries, queues, compaction.list, compaction.flags, size, first, pass,
                   settings.seed, index, features.hasCausticMap, maps.nearDistance, pixelAngle, settings.integrator});
    compaction.compact(recording);

    const auto queue = [&](uint kind) { return Ptr<Queue>{queues.address + kind * sizeof(Queue)}; };
    if (shadow) recording.run(*shadow, queues, QUEUE_SHADOW, {scene.address, shadowRays, samples, queue(QUEUE_SHADOW), compaction.list, size});
    if (maps.caustic.cells.address)
        recording.run(*gather, queues, QUEUE_CAUSTIC, {maps.caustic, queries, samples, queue(QUEUE_CAUSTIC), compaction.list, size});
    if (maps.global.cells.address)
        recording.run(*gather, queues, QUEUE_GLOBAL, {maps.global, queries, samples, queue(QUEUE_GLOBAL), compaction.list, size});
}

RayCounts CameraPaths::trace(uint pass, uint first, uint count, const PhotonMaps& maps) {
    Recording recording(gpu);
    compaction.start(count);
    recording.run(eye, count,
                  {scene.address, paths, samples, compaction.list, size, settings.size, first, count, pass, settings.seed, settings.showPoints});

    // Batches of bounces, until the device says that no path is left.
    std::vector<Queue> queues;
    for (uint index = 0; index < maxBounces;) {
        for (const uint end = index + bouncesAtOnce; index < end; index++) bounce(recording, pass, first, index, maps);
        recording.submit();
        queues = compaction.queues.download();
        if (queues[QUEUE_CONTINUE].count == 0) break;
    }
    return {queues[QUEUE_CONTINUE].base, std::uint64_t(queues[QUEUE_SHADOW].base) + queues[QUEUE_SHADOW].count};
}

} // namespace vkpm
