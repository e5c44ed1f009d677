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

const uint furtherPaths = 1u << 28; // of a pixel: their indices begin there, beyond those of the most passes

RayCounts CameraBatch::rays() const {
    RayCounts rays;
    for (const auto* sequences : {&eye, &splits})
        for (const auto& sequence : *sequences) {
            rays.paths += sequence[QUEUE_CONTINUE].base;
            rays.shadow += std::uint64_t(sequence[QUEUE_SHADOW].base) + sequence[QUEUE_SHADOW].count;
        }
    rays.paths -= std::uint64_t(splits.size()) * count; // those that were looked at for gather rays
    return rays;
}

/// Paths of a pixel. Where there are no maps to ask, passes do as well.
static uint pixelSamplesOf(const Settings& settings) {
    return settings.integrator == INTEGRATOR_PHOTON ? settings.pixelSamples : 1;
}

static bool sharesGathers(const Features& features, const Settings& settings) {
    return settings.integrator == INTEGRATOR_PHOTON && features.hasGlobalMap && asksLights(features, settings);
}

/// Pixels of a batch: whole bands, at least one, if pixels of a band share.
static uint batchOf(uvec2 picture, uint wanted, bool shares) {
    const uint band = SHARING_BAND * picture.x;
    return shares ? std::max(wanted / band, 1u) * band : wanted;
}

/// Rows of the first band that lie above the picture: where bands meet differs from pass to pass.
static uint bandShift(uint pass) { return pass * 13 % SHARING_BAND; } // 13: each once in that many passes

CameraPaths::CameraPaths(Gpu& device, const UploadedScene& uploaded, const Features& has, const Settings& set,
                         uint batchSize, uint firstRounds)
    : gpu(device), scene(uploaded), settings(set), features(has), pixelSamples(pixelSamplesOf(set)),
      shares(sharesGathers(has, set)), batch(batchOf(set.size, batchSize, shares)),
      size(std::min(set.size.x * set.size.y, batch + (shares ? SHARING_BAND * set.size.x : 0))), rounds(firstRounds),
      compaction(gpu, "camera", size, EYE_QUEUES), paths(gpu, "camera paths", size), hits(gpu, "camera hits", size),
      progress(gpu, "camera progress", 1), eye(gpu, "eye", features), traceKernel(gpu, "trace", features),
      shade(gpu, "shade", features) {
    const Columns columns(features);
    samples = Buffer<float>(gpu, "camera samples", std::uint64_t(columns.cameraColumns()) * size);
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
        if (shares) share.emplace(gpu, "share_gathers", features);
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
void CameraPaths::recordRound(Recording& recording, const Paths& of, uint round) {
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
                   of.first,
                   of.sequence,
                   of.index,
                   settings.seed,
                   of.sequence == SAMPLES_EYE ? round : round + 1, // bounces before
                   features.hasCausticMap,
                   of.sequence != SAMPLES_EYE ? 1
                   : of.asks                  ? float(pixelSamples)
                                              : 0,
                   1 / float(pixelSamples),
                   maps.nearDistance,
                   pixelAngle,
                   settings.integrator});
    compaction.compact(recording, round + 1, round + 1 == rounds, progress);

    const bool splits = split && of.sequence == SAMPLES_EYE; // and asks for nothing that a gather ray asks for
    if (!splits || hasMaterials(features, GLOSSY_KINDS)) castShadowRays(recording);
    for (const PhotonMap& narrow : maps.narrow) queryPhotonMap(recording, QUEUE_CAUSTIC, narrow);
    queryPhotonMap(recording, QUEUE_CAUSTIC, maps.caustic);
    if (!splits || features.hasWide) queryPhotonMap(recording, QUEUE_GLOBAL, maps.global);
}

/// All rounds of a sequence of paths: as many as are known to do, or until the device says that no path is left.
void CameraPaths::recordPaths(Recording& recording, const Paths& of, std::array<Queue, EYE_QUEUES>& queues) {
    uint round = 0;
    do {
        for (const uint end = round + (rounds ? rounds : roundsAtOnce); round < end; round++)
            recordRound(recording, of, round);
        recording.read(compaction.queues, std::span(queues));
        if (rounds == 0) recording.submit();
    } while (rounds == 0 && queues[QUEUE_CONTINUE].count > 0 && round < MAX_BOUNCES);
}

/// Pixels give each other what their gather rays brought.
void CameraPaths::shareGathers(Recording& recording, const CameraBatch& batch) {
    if (!share || maps.marks) return;
    recording.run(*share, batch.count,
                  {scene.address, splits, samples, size, batch.count, batch.first / settings.size.x, settings.size.x,
                   bandShift(pass), pass, maps.sharingRadius, float(pixelSamples)});
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

/// Sends light samples and gather rays from splits, and takes the light samples.
void CameraPaths::sendSplits(Recording& recording, const Paths& of, float share, uint sends) {
    const uint count = of.count;
    compaction.start(recording, count);
    recording.run(*split, count,
                  {scene.address, splits, paths, shadowRays, compaction.list, compaction.flags, of.first, count,
                   of.index, settings.seed, share, sends});
    compaction.compact(recording);
    castShadowRays(recording);
}

/// A path of each pixel. Gather rays start where the first one ends; the others have light samples alone.
void CameraPaths::recordEyePath(Recording& recording, CameraBatch& batch, uint path) {
    const bool isFirst = path == 0;
    // Those of the first path complement each other over all passes, and so do those of the others.
    const uint further = furtherPaths + pass * (pixelSamples - 1) + path - 1, index = isFirst ? pass : further;
    compaction.start(recording, batch.count);
    recording.run(eye, batch.count,
                  {scene.address, paths, samples, compaction.list, splits, size, settings.size, batch.first,
                   batch.count, index, settings.seed, settings.showPoints, split.has_value(), isFirst,
                   1 / float(pixelSamples)});
    recordPaths(recording, {batch.first, batch.count, SAMPLES_EYE, index, isFirst}, batch.eye.emplace_back());
    if (!split) return;
    if (isFirst) {
        for (uint ray = 0; ray < settings.gatherRays; ray++) {
            const Paths gathering{batch.first, batch.count, SAMPLES_GATHER, pass * settings.gatherRays + ray, true};
            sendSplits(recording, gathering, 1 / float(settings.gatherRays), SPLIT_GATHERS);
            recordPaths(recording, gathering, batch.splits.emplace_back());
        }
        shareGathers(recording, batch);
        return;
    }
    const bool endless = (features.lightKinds & ENDLESS_KINDS) != 0;
    for (const uint sends : {SPLIT_LIGHT, SPLIT_BEYOND}) {
        if (sends == SPLIT_BEYOND && !endless) continue;
        sendSplits(recording, {batch.first, batch.count, SAMPLES_GATHER, further, false}, 1, sends);
        recording.read(compaction.queues, std::span(batch.splits.emplace_back()));
    }
}

void CameraPaths::record(Recording& recording, CameraBatch& batch) {
    batch.eye.clear();
    batch.splits.clear();
    batch.eye.reserve(pixelSamples); // they stay where they are: the device's counts go there
    batch.splits.reserve(settings.gatherRays + 2 * pixelSamples);
    recording.clear(progress);
    for (uint path = 0; path < pixelSamples; path++) recordEyePath(recording, batch, path);
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
