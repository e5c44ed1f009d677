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

// What paths of a small picture mark, in pixels of it: those of caustics what lies between two of them, gather rays,
// which are few and go everywhere, what lies about.
const float pixelReach = 2, rayReach = 8;

CameraPaths::CameraPaths(Gpu& device, const UploadedScene& uploaded, const Features& has, const Settings& set,
                         uint batch)
    : gpu(device), scene(uploaded), settings(set), features(has), size(std::min(set.size.x * set.size.y, batch)),
      compaction(gpu, "camera", size, EYE_QUEUES), paths(gpu, "camera paths", size), hits(gpu, "camera hits", size),
      eye(gpu, "eye", features), traceKernel(gpu, "trace", features), shade(gpu, "shade", features) {
    samples = Buffer<float>(gpu, "camera samples", std::uint64_t(Columns(features).SAMPLE_COLUMNS) * size);
    if (asksLights(features, settings)) {
        shadowRays = Buffer<ShadowRay>(gpu, "camera shadow rays", size);
        shadow.emplace(gpu, "shadow", features);
    }
    if (asksMaps(features)) {
        queries = Buffer<Query>(gpu, "camera queries", size);
        gather.emplace(gpu, settings.showPoints ? "show_photons" : "gather", features);
    }
    if (settings.integrator == INTEGRATOR_PHOTON && shadow) {
        splits = Buffer<Split>(gpu, "camera splits", size);
        split.emplace(gpu, "split", features);
    }
}

void CameraPaths::castShadowRays(Recording& recording) {
    const Buffer<Queue>& queues = compaction.queues;
    const Ptr<Queue> queue{queues.address + QUEUE_SHADOW * sizeof(Queue)};
    if (shadow)
        recording.run(*shadow, queues, QUEUE_SHADOW,
                      {scene.address, shadowRays, samples, queue, compaction.list, size});
}

/// Answers the questions of a queue to a map, or marks where they were asked.
void CameraPaths::queryPhotonMap(Recording& recording, const Batch& batch, uint kind, const PhotonMap& map) {
    if (map.radius == 0) return;
    const Ptr<Queue> queue{compaction.queues.address + kind * sizeof(Queue)};
    if (!batch.maps.marks) {
        recording.run(*gather, compaction.queues, kind, {map, queries, samples, queue, compaction.list, size});
        return;
    }
    const VisibleCells::Map& marks = kind == QUEUE_CAUSTIC ? batch.maps.marks->caustic : batch.maps.marks->global;
    const float reach = kind == QUEUE_CAUSTIC ? pixelReach : rayReach;
    recording.run(batch.maps.marks->kernel, compaction.queues, kind,
                  {map, queries, queue, compaction.list, marks.bits, marks.cellWidth, reach});
}

void CameraPaths::bounce(Recording& recording, const Batch& batch, uint index) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(shade, queues, QUEUE_CONTINUE,
                  {scene.address,
                   paths,
                   hits,
                   samples,
                   shadowRays,
                   queries,
                   splits,
                   queues,
                   compaction.list,
                   compaction.flags,
                   size,
                   batch.first,
                   batch.sequence,
                   batch.index,
                   settings.seed,
                   index,
                   features.hasCausticMap,
                   batch.maps.nearDistance,
                   pixelAngle,
                   settings.integrator});
    compaction.compact(recording);

    castShadowRays(recording);
    for (const PhotonMap& narrow : batch.maps.narrow) queryPhotonMap(recording, batch, QUEUE_CAUSTIC, narrow);
    queryPhotonMap(recording, batch, QUEUE_CAUSTIC, batch.maps.caustic);
    queryPhotonMap(recording, batch, QUEUE_GLOBAL, batch.maps.global);
}

/// Batches of bounces, until the device says that no path is left.
RayCounts CameraPaths::follow(Recording& recording, const Batch& batch, uint index) {
    std::vector<Queue> queues;
    while (index < maxBounces) {
        for (uint i = 0; i < bouncesAtOnce; i++) bounce(recording, batch, index++);
        recording.submit();
        queues = compaction.queues.download();
        if (queues[QUEUE_CONTINUE].count == 0) break;
    }
    return {queues[QUEUE_CONTINUE].base, std::uint64_t(queues[QUEUE_SHADOW].base) + queues[QUEUE_SHADOW].count};
}

RayCounts CameraPaths::trace(uint pass, uint first, uint count, const PhotonMaps& maps) {
    Recording recording(gpu);
    const Batch batch{first, count, SAMPLES_EYE, pass, maps};
    pixelAngle = 2 * glm::length(scene.camera().up) / float(settings.size.y);
    compaction.start(count);
    recording.run(eye, count,
                  {scene.address, paths, samples, compaction.list, splits, size, settings.size, first, count, pass,
                   settings.seed, settings.showPoints, split.has_value()});
    RayCounts rays = follow(recording, batch, 0);
    if (!split) return rays;

    const uint gatherRays = settings.gatherRays;
    for (uint ray = 0; ray < gatherRays; ray++) {
        const Batch gathering{first, count, SAMPLES_GATHER, pass * gatherRays + ray, maps};
        compaction.start(count);
        recording.run(*split, count,
                      {scene.address, splits, paths, shadowRays, compaction.list, compaction.flags, first, count,
                       gathering.index, settings.seed, 1 / float(gatherRays)});
        compaction.compact(recording);
        castShadowRays(recording);
        rays += follow(recording, gathering, 1);
        rays.paths -= count; // those that were looked at
    }
    return rays;
}

} // namespace vkpm
