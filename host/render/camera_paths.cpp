/// The camera loop: eye, then rounds of trace, shade, shadow and gather until no path is under way.
#include "render/camera_paths.h"
#include "render/features.h"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

// Mark radius in pilot pixels: caustic queries cover the gap to their neighbours; gather rays are few and scattered, so
// they cover more.
const float pixelReach = 2, rayReach = 8;

const uint roundsAtOnce = 4; // recorded before the host looks whether any path is left

// Recorded beyond those that paths have needed so far. The longest path is a matter of luck: too many rounds cost next
// to nothing, too few a batch.
const uint spareRounds = 8;

RayCounts CameraBatch::rays() const {
    RayCounts rays;
    for (const auto& sequence : sequences) {
        rays.paths += sequence[QUEUE_CONTINUE].base;
        rays.shadow += std::uint64_t(sequence[QUEUE_SHADOW].base) + sequence[QUEUE_SHADOW].count;
    }
    rays.paths -= lookedAt;
    return rays;
}

/// Paths of a pixel. Where there are no maps to ask, passes do as well.
static uint pixelSamplesOf(const Settings& settings) {
    return settings.integrator == INTEGRATOR_PHOTON ? settings.pixelSamples : 1;
}

static bool sharesGathers(const Features& features, const Settings& settings) {
    return settings.integrator == INTEGRATOR_PHOTON && features.hasGlobalMap && asksLights(features, settings);
}

/// Paths of a pixel that are traced together, whose samples are added in this order: it depends on the settings alone.
/// Bands of a wide picture have to fit.
static uint lanesOf(uvec2 picture, uint paths) {
    const uint most = COMPACTION_BLOCK * MAX_COMPACTION_BLOCKS / (2 * SHARING_BAND * picture.x);
    return std::clamp(most, 1u, std::min(paths, MAX_LANES));
}

/// Pixels of a batch: whole bands, at least one, if pixels of a band share.
static uint batchOf(uvec2 picture, uint wanted, bool shares) {
    const uint band = SHARING_BAND * picture.x;
    return shares ? std::max(wanted / band, 1u) * band : std::max(wanted, 1u);
}

/// Rows of the first band that lie above the picture: where bands meet differs from pass to pass.
static uint bandShift(uint pass) { return pass * 13 % SHARING_BAND; } // 13: each once in that many passes

CameraPaths::CameraPaths(Gpu& device, const UploadedScene& uploaded, const Features& has, const Settings& set,
                         uint batchSize, uint firstRounds)
    : gpu(device), scene(uploaded), settings(set), features(has), pixelSamples(pixelSamplesOf(set)),
      shares(sharesGathers(has, set)), lanes(lanesOf(set.size, pixelSamples)),
      // Labels know the events of the first path in its lane alone.
      gatherLanes(has.hasLabels ? 1 : std::min(lanes, set.gatherRays)),
      batch(batchOf(set.size, batchSize / lanes, shares)),
      pixels(std::min(set.size.x * set.size.y, batch + (shares ? SHARING_BAND * set.size.x : 0))), size(lanes * pixels),
      rounds(firstRounds), compaction(gpu, "camera", size, EYE_QUEUES), paths(gpu, "camera paths", size),
      hits(gpu, "camera hits", size), progress(gpu, "camera progress", 1), eye(gpu, "eye", features),
      traceKernel(gpu, "trace", features), shade(gpu, "shade", features) {
    const Columns columns(features);
    samples = Buffer<float>(gpu, "camera samples", std::uint64_t(columns.cameraColumns()) * size);
    if (asksLights(features, settings)) {
        shadowRays = Buffer<ShadowRay>(gpu, "camera shadow rays", size);
        shadow.emplace(gpu, "shadow", features);
    }
    if (asksMaps(features)) {
        // Further paths ask no map but after a wide lobe.
        queries = Buffer<Query>(gpu, "camera queries", has.hasWide ? size : pixels * gatherLanes);
        gather.emplace(gpu, settings.showPoints ? "show_photons" : "gather", features);
    }
    if (settings.integrator == INTEGRATOR_PHOTON && shadow) {
        splits = Buffer<Split>(gpu, "camera splits", size);
        split.emplace(gpu, "split", features);
        if (shares) share.emplace(gpu, "share_gathers", features);
    }
    if (lanes > 1) sum.emplace(gpu, "sum_lanes", features);
}

void CameraPaths::castShadowRays(Recording& recording) {
    const Buffer<Queue>& queues = compaction.queues;
    const Ptr<Queue> queue{queues.address + QUEUE_SHADOW * sizeof(Queue)};
    if (shadow)
        recording.run(*shadow, queues, QUEUE_SHADOW,
                      {scene.address, shadowRays, samples, queue, compaction.list, size});
}

/// Answers the questions of a queue to a map, or marks where they were asked.
void CameraPaths::queryPhotonMap(Recording& recording, uint kind, const PhotonMap& map) {
    if (map.radius == 0) return;
    const Ptr<Queue> queue{compaction.queues.address + kind * sizeof(Queue)};
    if (!maps.marks) {
        const bool clips = settings.integrator == INTEGRATOR_PHOTON;
        recording.run(
            *gather, compaction.queues, kind,
            {map, queries, samples, queue, compaction.list, clips ? scene.address : Ptr<DeviceScene>{}, size});
        return;
    }
    const VisibleCells::Map& marks = kind == QUEUE_CAUSTIC ? maps.marks->caustic : maps.marks->global;
    const float reach = kind == QUEUE_CAUSTIC ? pixelReach : rayReach;
    recording.run(maps.marks->kernel, compaction.queues, kind,
                  {map, queries, queue, compaction.list, marks.bits, marks.cellWidth, reach});
}

/// One bounce of all paths under way, and the answers to what they ask.
void CameraPaths::recordRound(Recording& recording, const Paths& traced, uint round) {
    const Buffer<Queue>& queues = compaction.queues;
    const bool gathers = traced.sequence == SAMPLES_GATHER;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(shade, queues, QUEUE_CONTINUE,
                  {scene.address, paths, hits, samples, shadowRays, queries, splits, queues, compaction.list,
                   compaction.flags, traced.of, size,
                   (gathers ? SHADE_GATHER_RAYS : 0) | (features.hasCausticMap ? SHADE_CAUSTICS : 0),
                   gathers ? round + 1 : round, // bounces before
                   maps.nearDistance, pixelAngle, settings.integrator});
    compaction.compact(recording, round + 1, round + 1 == rounds, progress);

    const bool splits = split && !gathers; // and asks for nothing that a gather ray asks for
    if (!splits || hasMaterials(features, GLOSSY_KINDS)) castShadowRays(recording);
    for (const PhotonMap& narrow : maps.narrow) queryPhotonMap(recording, QUEUE_CAUSTIC, narrow);
    queryPhotonMap(recording, QUEUE_CAUSTIC, maps.caustic);
    if (!splits || features.hasWide) queryPhotonMap(recording, QUEUE_GLOBAL, maps.global);
}

/// All rounds of a sequence of paths: as many as are known to do, or until the device says that no path is left.
void CameraPaths::recordPaths(Recording& recording, const Paths& traced, CameraBatch& batch) {
    std::array<Queue, EYE_QUEUES>& queues = batch.sequences.emplace_back();
    uint round = 0;
    do {
        for (const uint end = round + (rounds ? rounds : roundsAtOnce); round < end; round++)
            recordRound(recording, traced, round);
        recording.read(compaction.queues, std::span(queues));
        if (rounds == 0) recording.submit();
    } while (rounds == 0 && queues[QUEUE_CONTINUE].count > 0 && round < MAX_BOUNCES);
}

std::vector<CameraBatch> CameraPaths::batches(uint index) const {
    const uint pixels = settings.size.x * settings.size.y;
    const uint above = shares ? bandShift(index) * settings.size.x : 0;
    const uint count = (pixels + batch - 1) / batch; // the last one is longer by what the first one lacks
    std::vector<CameraBatch> batches;
    for (uint i = 0; i < count; i++) {
        const uint first = i == 0 ? 0 : i * batch - above;
        batches.push_back({.first = first, .count = (i + 1 == count ? pixels : (i + 1) * batch - above) - first});
    }
    return batches;
}

void CameraPaths::begin(uint index, const PhotonMaps& asked) {
    pass = index;
    maps = asked;
    pixelAngle = 2 * glm::length(scene.camera().up) / float(settings.size.y);
}

void CameraPaths::recordEyePaths(Recording& recording, const Paths& traced, CameraBatch& batch) {
    compaction.start(recording, traced.count());
    recording.run(eye, traced.count(),
                  {scene.address, paths, samples, compaction.list, splits, traced.of, size, traced.count(),
                   settings.size, settings.showPoints, split.has_value()});
    recordPaths(recording, traced, batch);
}

/// Sends light samples and gather rays from splits, and takes the light samples.
void CameraPaths::sendSplits(Recording& recording, const Paths& traced, uint sends, uint firstLane) {
    const uint first = firstLane * traced.of.pixels, count = traced.count() - first;
    compaction.start(recording, count);
    recording.run(
        *split, count,
        {scene.address, splits, paths, shadowRays, compaction.list, compaction.flags, traced.of, first, count, sends});
    compaction.compact(recording);
    castShadowRays(recording);
}

/// Gather rays from where the first path of each pixel ends, which bring light in lanes of their own.
void CameraPaths::recordGatherRays(Recording& recording, CameraBatch& batch) {
    for (uint ray = 0; ray < settings.gatherRays; ray += gatherLanes) {
        const LanePaths of{batch.first, batch.count, pass, ray, settings.gatherRays, settings.seed};
        const Paths gathering{of, std::min(gatherLanes, settings.gatherRays - ray), SAMPLES_GATHER};
        sendSplits(recording, gathering, SPLIT_GATHERS);
        recordPaths(recording, gathering, batch);
        batch.lookedAt += gathering.count();
    }
    const Columns columns(features);
    sumLanes(recording, batch.count, gatherLanes, columns.SAMPLE_COLUMNS, columns.cameraColumns());
    shareGathers(recording, batch);
}

/// Light samples from where the further paths of a pixel end.
void CameraPaths::sendLightSamples(Recording& recording, const Paths& traced, CameraBatch& batch) {
    const uint firstLane = traced.of.first == 0 ? 1 : 0;
    const bool endless = (features.lightKinds & ENDLESS_KINDS) != 0;
    if (firstLane == traced.lanes) return;
    for (const uint sends : {SPLIT_LIGHT, SPLIT_BEYOND}) {
        if (sends == SPLIT_BEYOND && !endless) continue;
        sendSplits(recording, traced, sends, firstLane);
        recording.read(compaction.queues, std::span(batch.sequences.emplace_back()));
        batch.lookedAt += traced.count() - firstLane * traced.of.pixels;
    }
}

/// Adds columns of other lanes to those of the first one.
void CameraPaths::sumLanes(Recording& recording, uint count, uint lanesUsed, uint firstColumn, uint endColumn) {
    if (sum && lanesUsed > 1 && firstColumn < endColumn)
        recording.run(*sum, count, {samples, size, count, lanesUsed, firstColumn, endColumn});
}

/// Pixels give each other what their gather rays brought.
void CameraPaths::shareGathers(Recording& recording, const CameraBatch& batch) {
    if (!share || maps.marks) return;
    recording.run(*share, batch.count,
                  {scene.address, splits, samples, size, batch.count, batch.first / settings.size.x, settings.size.x,
                   bandShift(pass), pass, maps.sharingRadius, float(pixelSamples)});
}

void CameraPaths::record(Recording& recording, CameraBatch& batch) {
    batch.sequences.clear();
    batch.sequences.reserve(settings.gatherRays + 3 * pixelSamples); // they stay: the device's counts go there
    batch.lookedAt = 0;
    recording.clear(progress);
    recording.clear(samples);
    for (uint path = 0; path < pixelSamples; path += lanes) {
        const LanePaths of{batch.first, batch.count, pass, path, pixelSamples, settings.seed};
        const Paths fromEye{of, std::min(lanes, pixelSamples - path), SAMPLES_EYE};
        recordEyePaths(recording, fromEye, batch);
        if (!split) continue;
        if (path == 0) recordGatherRays(recording, batch);
        sendLightSamples(recording, fromEye, batch);
    }
    const Columns columns(features);
    // Further paths end where they meet something diffuse, unless a wide lobe came before.
    sumLanes(recording, batch.count, lanes, 0, features.hasWide ? columns.COLUMN_ALBEDO : columns.COLUMN_CAUSTIC);
    sumLanes(recording, batch.count, lanes, columns.COLUMN_ALBEDO,
             features.hasWide ? columns.SAMPLE_COLUMNS : columns.COLUMN_BIAS);
    recording.read(progress, 0, batch.progress);
}

bool CameraPaths::finish(const CameraBatch& batch) {
    if (batch.progress.unfinished) {
        rounds = 0; // for once, the host looks when paths end
        return false;
    }
    rounds = std::min(std::max(rounds, batch.progress.rounds + 1 + spareRounds), MAX_BOUNCES);
    return true;
}

} // namespace vkpm
