/// Photons from the lights to the diffuse surfaces where they arrive.
#pragma once
#include "render/compaction.h"
#include "render/uploaded_scene.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_sort.h"
#include <optional>

namespace vkpm {

/// What became of the photons of one or more passes. Every photon emitted is absorbed, escapes, or is lost to the limit
/// of bounces; of the caustic map, one that misses what it was aimed at escapes.
struct PhotonLedger {
    std::uint64_t emitted = 0;
    std::uint64_t stored = 0;
    std::uint64_t absorbed = 0;
    std::uint64_t escaped = 0;
    std::uint64_t lost = 0;
    std::uint64_t rays = 0;
    std::uint64_t nonfinite = 0;

    PhotonLedger& operator+=(const PhotonLedger& other);
};

enum class MapKind : uint { global = 0, caustic = 1 };

/// Emits `count` photons per pass, `batchSize` of them at a time, and keeps where they arrive in the order of their
/// indices, those of one photon in the order of its bounces; the size of batches changes nothing.
class PhotonTracing {
public:
    PhotonTracing(Gpu& gpu, const UploadedScene& scene, const Features& features, MapKind kind, uint count, uint seed,
                  uint batchSize);

    /// Records what fills `photons` with those of a pass, unless they are there already.
    void record(Recording& recording, uint pass);
    /// Whether what was recorded, and submitted since, has filled them; else there is room now, and it is to be
    /// recorded again.
    bool finish();
    /// Records and submits until they are there. Returns what became of them.
    const PhotonLedger& trace(uint pass);
    /// What became of the photons that are there.
    const PhotonLedger& ledger() const { return passLedger; }

    /// Starts photons by a guide's density, or uniformly if it has no nodes; how, and how useful each was, goes to
    /// `starts`, if there are any.
    void guide(Ptr<GuideNode> nodes, Ptr<PrimarySample> starts = {});
    /// Where the photons of each path begin, if there is one batch.
    Ptr<uint> places() const { return counts; }
    /// How many photons there are.
    std::uint64_t arrived() const { return held ? passLedger.stored : 0; }

    Buffer<Photon> photons;
    bool connects = false; // they are connected to the camera

private:
    /// A part of a pass, and what the host hears of it.
    struct Batch {
        uint pass;
        uint first; // photon
        uint size;
        Queue left{}; // paths that did not end
        std::uint64_t lost = 0;
        Status status{};

        PhotonLedger ledger() const;
    };

    void recordPaths(Recording& recording, const Batch& batch);
    void recordBounces(Recording& recording, const Batch& batch, uint bounce, uint bounces);
    void followEnds(Recording& recording, Batch& batch);
    void recordPhotons(Recording& recording, Batch& batch);
    void measureRoom(uint pass);
    bool makeRoom(std::uint64_t depositCount, std::uint64_t photonCount);

    Gpu& gpu;
    const UploadedScene& scene;
    Features features;
    MapKind kind;
    uint count;
    uint seed;
    uint batchSize;
    Ptr<GuideNode> guideNodes;
    Ptr<PrimarySample> starts;
    std::optional<uint> held;     // pass whose photons these are
    std::optional<uint> recorded; // pass whose photons they will be
    PhotonLedger passLedger;
    std::vector<Batch> batches; // of the pass that was recorded
    bool endsLate = false;      // whether some photons do not end in one dispatch
    std::string name;
    Compaction compaction;
    Buffer<Path> paths;
    Buffer<PhotonDeposit> deposits;
    Buffer<uint> counts; // of a path's deposits, then where they go
    Buffer<uint> stored; // of the batches so far
    Buffer<Queue> whole; // all paths of the batch
    Buffer<Status> status;
    Kernel<EmitArgs> emit;
    Kernel<ScatterArgs> scatter;
    Kernel<ScanArgs> scan;
    Kernel<StorePhotonsArgs> placeKernel;
};

} // namespace vkpm
