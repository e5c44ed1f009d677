/// The photon loop: emit, then trace and scatter until no photon of the batch is under way, then place those that
/// arrived.
#include "render/photon_tracing.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <algorithm>

namespace vkpm {

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

PhotonTracing::PhotonTracing(Gpu& device, const UploadedScene& uploaded, const Features& has, MapKind mapKind,
                             uint photonCount, uint sequence, uint batchSize)
    : gpu(device), scene(uploaded), features(has), kind(mapKind), count(photonCount), seed(sequence),
      batch(std::min(batchSize, count)), name(mapKind == MapKind::caustic ? "caustic photon" : "global photon"),
      compaction(gpu, name, batch, PHOTON_QUEUES), paths(gpu, name + " paths", batch), hits(gpu, name + " hits", batch),
      counts(gpu, name + " counts", batch + 1ull), whole(gpu, name + " batch", 1), status(gpu, name + " status", 1),
      emit(gpu, "emit", features), traceKernel(gpu, "trace", features), scatter(gpu, "scatter", features),
      scan(gpu, "scan"), placeKernel(gpu, "store_photons") {
    const uint perPhoton = kind == MapKind::caustic ? 1 : 2; // to begin with
    deposits = Buffer<PhotonDeposit>(gpu, name + " deposits", std::uint64_t(perPhoton) * batch);
}

void PhotonTracing::guide(Ptr<GuideNode> nodes, Ptr<PrimarySample> toFill) {
    Features emission = features;
    emission.hasGuide |= nodes.address || toFill.address;
    emit = Kernel<EmitArgs>(gpu, "emit", emission);
    guideNodes = nodes;
    starts = toFill;
    held.reset();
}

void PhotonTracing::bounce(Recording& recording, uint pass, uint first, uint index) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(traceKernel, queues, QUEUE_CONTINUE, {scene.address, paths, hits, queues, compaction.list});
    recording.run(scatter, queues, QUEUE_CONTINUE,
                  {scene.address, paths, hits, deposits, counts, queues, compaction.list, compaction.flags, status,
                   static_cast<uint>(deposits.size()), first, pass, seed, index, uint(kind)});
    compaction.compact(recording);
}

PhotonLedger PhotonTracing::traceBatch(uint pass, uint first, uint size) {
    Recording recording(gpu);
    recording.clear(status);
    compaction.start(size);
    recording.run(emit, size,
                  {scene.address, paths, compaction.list, compaction.flags, counts, status, guideNodes, starts, first,
                   size, pass, seed, uint(kind)});
    compaction.compact(recording);

    // Batches of bounces, until the device says that no photon is left.
    Queue queue{};
    for (uint index = 0; index < maxBounces;) {
        for (const uint end = index + bouncesAtOnce; index < end; index++) bounce(recording, pass, first, index);
        recording.submit();
        queue = compaction.queues.readElement(QUEUE_CONTINUE);
        if (queue.count == 0) break;
    }

    const Status result = status.readElement();
    return {.emitted = size,
            .stored = result.deposits,
            .absorbed = result.absorbed,
            .escaped = result.escaped,
            .lost = queue.count,
            .rays = std::uint64_t(queue.base) - size};
}

/// Puts the deposits of a batch behind the photons of the batches before it, and counts those that are not finite.
void PhotonTracing::place(std::uint64_t first, uint arrived, uint size) {
    const Queue all{.count = size};
    whole.upload(std::span(&all, 1));
    Recording recording(gpu);
    recording.run(scan, GROUP, {counts, whole, 1, 1});
    recording.run(placeKernel, arrived, {deposits, counts, photons, status, static_cast<uint>(first), arrived});
    recording.submit();
}

PhotonLedger PhotonTracing::attemptBatch(uint pass, uint first, uint size, std::uint64_t stored) {
    PhotonLedger ledger = traceBatch(pass, first, size);
    // A pass is a pure function of its index: with room for all photons it repeats exactly.
    if (ledger.stored > deposits.size()) {
        deposits = {};
        deposits = Buffer<PhotonDeposit>(gpu, name + " deposits", ledger.stored + ledger.stored / 8);
        ledger = traceBatch(pass, first, size);
    }
    if (photons.size() == 0) { // about as many per photon as in the first batch
        const double expected = 1.02 * double(ledger.stored) / size * count;
        photons = Buffer<Photon>(gpu, name + "s", static_cast<std::uint64_t>(expected) + 1000);
    }
    if (stored + ledger.stored <= photons.size()) place(stored, static_cast<uint>(ledger.stored), size);
    ledger.nonfinite = status.readElement().nonfinite[NONFINITE_PHOTON];
    return ledger;
}

PhotonLedger PhotonTracing::attempt(uint pass) {
    PhotonLedger ledger;
    for (uint first = 0; first < count; first += batch) {
        const uint size = std::min(batch, count - first);
        ledger += attemptBatch(pass, first, size, ledger.stored);
    }
    return ledger;
}

PhotonLedger PhotonTracing::trace(uint pass) {
    if (held == pass) return heldLedger;
    held.reset(); // until all are there
    heldLedger = attempt(pass);
    if (heldLedger.stored > photons.size()) {
        photons = {};
        photons = Buffer<Photon>(gpu, name + "s", heldLedger.stored + heldLedger.stored / 8);
        heldLedger = attempt(pass);
    }
    held = pass;
    return heldLedger;
}

} // namespace vkpm
