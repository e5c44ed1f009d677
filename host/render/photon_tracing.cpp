/// The photon loop: emit, then trace, scatter and deposit until no photon is under way.
#include "render/photon_tracing.h"

namespace vkpm {

const uint maxBounces = 10'000;
const uint bouncesAtOnce = 4; // recorded before the host looks whether any path is left; divides maxBounces

PhotonLedger& PhotonLedger::operator+=(const PhotonLedger& other) {
    emitted += other.emitted;
    stored += other.stored;
    absorbed += other.absorbed;
    escaped += other.escaped;
    lost += other.lost;
    rays += other.rays;
    nonfinite += other.nonfinite;
    return *this;
}

PhotonTracing::PhotonTracing(Gpu& device, const UploadedScene& uploaded, const Features& features, MapKind mapKind, uint photonCount, uint sequence)
    : gpu(device), scene(uploaded), kind(mapKind), count(photonCount), seed(sequence),
      name(mapKind == MapKind::caustic ? "caustic photon" : "global photon"), compaction(gpu, name, count, PHOTON_QUEUES),
      paths(gpu, name + " paths", count), hits(gpu, name + " hits", count), pending(gpu, name + " arrivals", count),
      status(gpu, name + " status", 1), emit(gpu, "emit", features), traceKernel(gpu, "trace", features),
      scatter(gpu, "scatter", features), deposit(gpu, "deposit", features) {
    photons = Buffer<Photon>(gpu, name + "s", kind == MapKind::caustic ? count : 3ull * count);
}

void PhotonTracing::bounce(Recording& recording, uint pass, uint index) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(scatter, queues, QUEUE_CONTINUE,
                  {scene.address, paths, hits, pending, queues, compaction.list, compaction.flags, status, pass, seed, index, uint(kind)});
    compaction.compact(recording);
    const Ptr<Queue> arrivals{queues.address + QUEUE_DEPOSIT * sizeof(Queue)};
    recording.run(deposit, queues, QUEUE_DEPOSIT, {arrivals, compaction.list, pending, photons, status, static_cast<uint>(photons.size())});
}

PhotonLedger PhotonTracing::attempt(uint pass) {
    Recording recording(gpu);
    recording.clear(status);
    compaction.start(count);
    recording.run(emit, count, {scene.address, paths, compaction.list, compaction.flags, status, count, pass, seed, uint(kind)});
    compaction.compact(recording);

    // Batches of bounces, until the device says that no photon is left.
    std::vector<Queue> queues;
    for (uint index = 0; index < maxBounces;) {
        for (const uint end = index + bouncesAtOnce; index < end; index++) bounce(recording, pass, index);
        recording.submit();
        queues = compaction.queues.download();
        if (queues[QUEUE_CONTINUE].count == 0) break;
    }

    const Status result = status.read1();
    const std::uint64_t stored = std::uint64_t(queues[QUEUE_DEPOSIT].base) + queues[QUEUE_DEPOSIT].count;
    return {.emitted = count,
            .stored = stored,
            .absorbed = result.absorbed,
            .escaped = result.escaped,
            .lost = queues[QUEUE_CONTINUE].count,
            .rays = std::uint64_t(queues[QUEUE_CONTINUE].base) - count,
            .nonfinite = result.nonfinite[NONFINITE_PHOTON]};
}

PhotonLedger PhotonTracing::trace(uint pass) {
    PhotonLedger ledger = attempt(pass);
    // A pass is a pure function of its index: with room for all photons it repeats exactly.
    if (ledger.stored > photons.size()) {
        photons = {};
        photons = Buffer<Photon>(gpu, name + "s", ledger.stored + ledger.stored / 8);
        ledger = attempt(pass);
    }
    return ledger;
}

} // namespace vkpm
