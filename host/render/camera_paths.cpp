/// The camera loop: eye, then trace, shade, shadow and gather until no path is under way.
#include "render/camera_paths.h"
#include "render/features.h"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

// What paths of a small picture mark, in pixels of it: those of caustics what lies between two of them, gather rays, which are few
// and go everywhere, what lies about.
const float pixelReach = 2, rayReach = 8;

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
    if (settings.integrator == INTEGRATOR_PHOTON && shadow) {
        splits = Buffer<Split>(gpu, "camera splits", size);
        split.emplace(gpu, "split", features);
    }
}

void CameraPaths::castShadowRays(Recording& recording) {
    const Buffer<Queue>& queues = compaction.queues;
    const Ptr<Queue> queue{queues.address + QUEUE_SHADOW * sizeof(Queue)};
    if (shadow) recording.run(*shadow, queues, QUEUE_SHADOW, {scene.address, shadowRays, samples, queue, compaction.list, size});
}

/// Answers the questions of a queue to a map, or marks where they were asked.
void CameraPaths::askMap(Recording& recording, const Wave& wave, uint kind, const PhotonMap& map) {
    if (map.radius == 0) return;
    const Ptr<Queue> queue{compaction.queues.address + kind * sizeof(Queue)};
    if (!wave.maps.marks) {
        recording.run(*gather, compaction.queues, kind, {map, queries, samples, queue, compaction.list, size});
        return;
    }
    const EyeMarks::Map& marks = kind == QUEUE_CAUSTIC ? wave.maps.marks->caustic : wave.maps.marks->global;
    const float reach = kind == QUEUE_CAUSTIC ? pixelReach : rayReach;
    recording.run(wave.maps.marks->kernel, compaction.queues, kind, {map, queries, queue, compaction.list, marks.bits, marks.cellWidth, reach});
}

void CameraPaths::bounce(Recording& recording, const Wave& wave, uint index) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(shade, queues, QUEUE_CONTINUE,
                  {scene.address, paths, hits, samples, shadowRays, queries, splits, queues, compaction.list, compaction.flags,
                   size, wave.first, wave.sequence, wave.index, settings.seed, index, features.hasCausticMap, wave.maps.nearDistance, pixelAngle,
                   settings.integrator});
    compaction.compact(recording);

    castShadowRays(recording);
    for (const PhotonMap& narrow : wave.maps.narrow) askMap(recording, wave, QUEUE_CAUSTIC, narrow);
    askMap(recording, wave, QUEUE_CAUSTIC, wave.maps.caustic);
    askMap(recording, wave, QUEUE_GLOBAL, wave.maps.global);
}

/// Batches of bounces, until the device says that no path is left.
RayCounts CameraPaths::follow(Recording& recording, const Wave& wave, uint index) {
    std::vector<Queue> queues;
    while (index < maxBounces) {
        for (uint i = 0; i < bouncesAtOnce; i++) bounce(recording, wave, index++);
        recording.submit();
        queues = compaction.queues.download();
        if (queues[QUEUE_CONTINUE].count == 0) break;
    }
    return {queues[QUEUE_CONTINUE].base, std::uint64_t(queues[QUEUE_SHADOW].base) + queues[QUEUE_SHADOW].count};
}

RayCounts CameraPaths::trace(uint pass, uint first, uint count, const PhotonMaps& maps) {
    Recording recording(gpu);
    const Wave wave{first, count, SAMPLES_EYE, pass, maps};
    pixelAngle = 2 * glm::length(scene.camera().up) / float(settings.size.y);
    compaction.start(count);
    recording.run(eye, count,
                  {scene.address, paths, samples, compaction.list, splits, size, settings.size, first, count, pass, settings.seed,
                   settings.showPoints, split.has_value()});
    RayCounts rays = follow(recording, wave, 0);
    if (!split) return rays;

    const uint gatherRays = settings.gatherRays;
    for (uint ray = 0; ray < gatherRays; ray++) {
        const Wave gathering{first, count, SAMPLES_GATHER, pass * gatherRays + ray, maps};
        compaction.start(count);
        recording.run(*split, count,
                      {scene.address, splits, paths, shadowRays, compaction.list, compaction.flags, first, count, gathering.index, settings.seed,
                       1 / float(gatherRays)});
        compaction.compact(recording);
        castShadowRays(recording);
        rays += follow(recording, gathering, 1);
        rays.paths -= count; // those that were looked at
    }
    return rays;
}

} // namespace vkpm
