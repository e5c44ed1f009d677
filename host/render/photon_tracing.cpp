/// A batch of photons: emit, then scatter, a bounce at a time and the last photons to their ends; then store those that
/// arrived.
#include "render/photon_tracing.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <algorithm>

namespace vkpm {

// Bounces that all photons of a batch take together, a dispatch each; then the few that are left take many in one.
const uint commonBounces = 6, bouncesOfFew = 250;

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
                             uint photonCount, uint sequence, uint size)
    : gpu(device), scene(uploaded), features(has), kind(mapKind), count(photonCount), seed(sequence),
      batchSize(std::min(size, count)), name(mapKind == MapKind::caustic ? "caustic photon" : "global photon"),
      compaction(gpu, name, batchSize, PHOTON_QUEUES), paths(gpu, name + " paths", batchSize),
      counts(gpu, name + " counts", batchSize + 1ull), stored(gpu, name + " stored", 1), whole(gpu, name + " batch", 1),
      status(gpu, name + " status", 1), emit(gpu, "emit", features), scatter(gpu, "scatter", features),
      scan(gpu, "scan"), placeKernel(gpu, "store_photons") {
    const uint perPhoton = kind == MapKind::caustic ? 1 : 2; // to begin with
    makeRoom(std::uint64_t(perPhoton) * batchSize, 0);
}

void PhotonTracing::guide(Ptr<GuideNode> nodes, Ptr<PrimarySample> toFill) {
    Features emission = features;
    emission.hasGuide |= nodes.address || toFill.address;
    emit = Kernel<EmitArgs>(gpu, "emit", emission);
    guideNodes = nodes;
    starts = toFill;
    held.reset();
}

PhotonLedger PhotonTracing::Batch::ledger() const {
    return {.emitted = size,
            .stored = status.deposits,
            .absorbed = status.absorbed,
            .escaped = status.escaped,
            .lost = lost,
            .rays = status.rays,
            .nonfinite = status.nonfinite[NONFINITE_PHOTON]};
}

/// The paths of a batch from the lights on, as far as they go together.
void PhotonTracing::recordPaths(Recording& recording, const Batch& batch) {
    recording.clear(status);
    compaction.start(recording, batch.size);
    recording.run(emit, batch.size,
                  {scene.address, paths, compaction.list, compaction.flags, counts, status, guideNodes, starts,
                   batch.first, batch.size, batch.pass, seed, uint(kind)});
    compaction.compact(recording);
    for (uint bounce = 0; bounce < commonBounces; bounce++) recordBounces(recording, batch, bounce, 1);
}

/// Takes the paths under way some bounces further.
void PhotonTracing::recordBounces(Recording& recording, const Batch& batch, uint bounce, uint bounces) {
    const Buffer<Queue>& queues = compaction.queues;
    recording.run(scatter, queues, QUEUE_CONTINUE,
                  {scene.address, paths, deposits, counts, queues, compaction.list, compaction.flags, status,
                   static_cast<uint>(deposits.size()), batch.first, batch.pass, seed, bounce, bounces, uint(kind),
                   connects});
    compaction.compact(recording);
}

/// Takes the last paths to their ends, until none is left or all have had MAX_BOUNCES.
void PhotonTracing::followEnds(Recording& recording, Batch& batch) {
    Queue queue{.count = 1};
    for (uint bounce = commonBounces; queue.count > 0 && bounce < MAX_BOUNCES; bounce += bouncesOfFew) {
        recordBounces(recording, batch, bounce, std::min(bouncesOfFew, MAX_BOUNCES - bounce));
        recording.read(compaction.queues, QUEUE_CONTINUE, queue);
        recording.submit();
    }
    batch.lost = queue.count;
}

/// Puts the deposits of a batch behind the photons of the batches before it, and counts those that are not finite.
void PhotonTracing::recordPhotons(Recording& recording, Batch& batch) {
    const Queue all{.count = batch.size};
    recording.write(whole, std::span(&all, 1));
    recording.run(scan, GROUP, {counts, whole, stored, 1, 1});
    recording.run(
        placeKernel, deposits.size(),
        {deposits, counts, photons, status, static_cast<uint>(deposits.size()), static_cast<uint>(photons.size())});
    recording.read(status, 0, batch.status);
}

/// Makes room for as many; false if there was none.
bool PhotonTracing::makeRoom(std::uint64_t depositCount, std::uint64_t photonCount) {
    const bool deposited = depositCount <= deposits.size(), fits = photonCount <= photons.size();
    if (!deposited) {
        deposits = {};
        deposits = Buffer<PhotonDeposit>(gpu, name + " deposits", depositCount);
    }
    if (!fits) {
        photons = {};
        photons = Buffer<Photon>(gpu, name + "s", photonCount);
    }
    return deposited && fits;
}

/// Makes room for about as many per photon as the first batch has.
void PhotonTracing::measureRoom(uint pass) {
    Batch batch{.pass = pass, .first = 0, .size = batchSize};
    Recording recording(gpu);
    recordPaths(recording, batch);
    recordBounces(recording, batch, commonBounces, bouncesOfFew);
    recording.read(status, 0, batch.status);
    recording.submit();
    const double expected = 1.02 * double(batch.status.deposits) / batchSize * count;
    const std::uint64_t found = batch.status.deposits;
    makeRoom(found > deposits.size() ? found + found / 8 : 0, static_cast<std::uint64_t>(expected) + 1000);
}

void PhotonTracing::record(Recording& recording, uint pass) {
    recorded.reset();
    if (held == pass) return;
    held.reset(); // until all are there
    if (photons.size() == 0) measureRoom(pass);
    batches.clear();
    for (uint first = 0; first < count; first += batchSize)
        batches.push_back({.pass = pass, .first = first, .size = std::min(batchSize, count - first)});
    recording.clear(stored);
    for (Batch& batch : batches) {
        recordPaths(recording, batch);
        if (endsLate) {
            followEnds(recording, batch);
        } else {
            recordBounces(recording, batch, commonBounces, bouncesOfFew);
            recording.read(compaction.queues, QUEUE_CONTINUE, batch.left);
        }
        recordPhotons(recording, batch);
        recording.flush();
    }
    recorded = pass;
}

// A pass is a pure function of its index: with room for all photons, and time for their ends, it repeats exactly.
bool PhotonTracing::finish() {
    if (!recorded) return held.has_value();
    PhotonLedger ledger;
    std::uint64_t most = 0;
    bool ended = true;
    for (const Batch& batch : batches) {
        ledger += batch.ledger();
        most = std::max<std::uint64_t>(most, batch.status.deposits);
        ended &= batch.left.count == 0 || endsLate;
    }
    endsLate |= !ended;
    const bool stays = makeRoom(most > deposits.size() ? most + most / 8 : 0,
                                ledger.stored > photons.size() ? ledger.stored + ledger.stored / 8 : 0);
    if (ended && stays) {
        held = recorded;
        passLedger = ledger;
    }
    recorded.reset();
    return held.has_value();
}

const PhotonLedger& PhotonTracing::trace(uint pass) {
    while (held != pass) {
        Recording recording(gpu);
        record(recording, pass);
        recording.submit();
        finish();
    }
    return passLedger;
}

} // namespace vkpm
