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

/// Emits `count` photons per pass, `batch` of them at a time, and keeps where they arrive in the order of their
/// indices, those of one photon in the order of its bounces; the size of batches changes nothing.
class PhotonTracing {
public:
    PhotonTracing(Gpu& gpu, const UploadedScene& scene, const Features& features, MapKind kind, uint count, uint seed,
                  uint batch);

    /// Fills `photons` with ledger.stored photons of a pass, unless they are there already.
    PhotonLedger trace(uint pass);
    /// Starts photons by a guide's density, or uniformly if it has no nodes; how, and how useful each was, goes to
    /// `starts`, if there are any.
    void guide(Ptr<GuideNode> nodes, Ptr<PrimarySample> starts = {});
    /// Where the photons of each path begin, if there is one batch.
    Ptr<uint> places() const { return counts; }
    /// How many photons there are.
    std::uint64_t arrived() const { return held ? heldLedger.stored : 0; }

    Buffer<Photon> photons;

private:
    PhotonLedger attempt(uint pass);
    PhotonLedger attemptBatch(uint pass, uint first, uint size, std::uint64_t stored);
    PhotonLedger traceBatch(uint pass, uint first, uint size);
    void place(std::uint64_t first, uint arrived, uint size);
    void bounce(Recording& recording, uint pass, uint first, uint bounce);

    Gpu& gpu;
    const UploadedScene& scene;
    Features features;
    MapKind kind;
    uint count;
    uint seed;
    uint batch;
    Ptr<GuideNode> guideNodes;
    Ptr<PrimarySample> starts;
    std::optional<uint> held; // pass whose photons these are
    PhotonLedger heldLedger;
    std::string name;
    Compaction compaction;
    Buffer<Path> paths;
    Buffer<Hit> hits;
    Buffer<PhotonDeposit> deposits;
    Buffer<uint> counts; // of a path's deposits, then their prefix sums
    Buffer<Queue> whole; // all paths of the batch
    Buffer<Status> status;
    Kernel<EmitArgs> emit;
    Kernel<TraceArgs> traceKernel;
    Kernel<ScatterArgs> scatter;
    Kernel<ScanArgs> scan;
    Kernel<StorePhotonsArgs> placeKernel;
};

} // namespace vkpm
