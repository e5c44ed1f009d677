/// The camera pass: a wavefront of eye paths, their shadow rays and their questions to the photon maps.
#pragma once
#include "render/compaction.h"
#include "render/uploaded_scene.h"
#include "shared_camera.h"
#include "shared_guide.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <array>
#include <optional>
#include <vector>

namespace vkpm {

/// Marks of the places where paths ask the maps, see visible_cells.glsl.
struct VisibleCells {
    struct Map {
        Buffer<uint> bits{};
        float cellWidth = 0; // of the finest cells
    };
    Kernel<MarkVisibleArgs> kernel;
    Map global{};
    Map caustic{};
};

/// The photon maps of a pass; one that the scene does not need has radius 0.
struct PhotonMaps {
    PhotonMap global{};
    PhotonMap caustic{};
    std::vector<PhotonMap> narrow{};     // of caustics, asked first: the narrowest discs first
    float nearDistance = 0;              // a gather ray shorter than this goes on
    float sharingRadius = 0;             // see share_gathers.comp
    const VisibleCells* marks = nullptr; // the places are marked there, and nothing is gathered
};

struct RayCounts {
    std::uint64_t paths = 0; // eye and gather rays
    std::uint64_t shadow = 0;

    RayCounts& operator+=(const RayCounts& other) { return paths += other.paths, shadow += other.shadow, *this; }
};

/// A range of pixels of a pass, and what the host hears of their paths.
struct CameraBatch {
    uint first; // pixel
    uint count;
    std::vector<std::array<Queue, EYE_QUEUES>> sequences{}; // of paths that are traced together
    std::uint64_t lookedAt = 0;                             // for gather rays and light samples, and no rays themselves
    PathRounds progress{};

    RayCounts rays() const;
};

/// Traces some paths for each pixel, and gather rays from where the first of them ends, for a range of pixels at a
/// time. Up to MAX_LANES paths of a pixel are traced together.
class CameraPaths {
public:
    CameraPaths(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings,
                uint batchSize, uint rounds = 0);

    /// Paths that may be under way: of the pixels of a batch, those of the first lane first.
    uint capacity() const { return size; }
    /// The batches of a pass.
    std::vector<CameraBatch> batches(uint pass) const;
    /// Begins a pass, until whose end `maps` stay as they are.
    void begin(uint pass, const PhotonMaps& maps);
    /// Records what fills the first lane of `samples` for the pixels of a batch, which has to stay where it is until
    /// that is done: as many rounds as paths have needed so far. Before that is known most of it is submitted, and the
    /// host looks when paths end.
    void record(Recording& recording, CameraBatch& batch);
    /// Points to a number that is not 0 if paths of the batch that was recorded last did not end.
    Ptr<uint> unfinished() const { return {progress.address + offsetof(PathRounds, unfinished)}; }
    /// Whether all paths of a batch, which was submitted, ended; else it is to be recorded again.
    bool finish(const CameraBatch& batch);

    /// Where gather rays of the last range of pixels started, if paths are split.
    const Buffer<Split>& splitPoints() const { return splits; }

    Buffer<float> samples; // [column][capacity]

private:
    /// Paths of a batch that are at the same bounce.
    struct Paths {
        LanePaths of;
        uint lanes;
        uint sequence; // SAMPLES_...

        uint count() const { return lanes * of.pixels; }
    };
    void castShadowRays(Recording& recording);
    void queryPhotonMap(Recording& recording, uint queue, const PhotonMap& map);
    void recordRound(Recording& recording, const Paths& traced, uint round);
    void recordPaths(Recording& recording, const Paths& traced, CameraBatch& batch);
    void sendSplits(Recording& recording, const Paths& traced, uint sends, uint firstLane = 0);
    void recordEyePaths(Recording& recording, const Paths& traced, CameraBatch& batch);
    void recordGatherRays(Recording& recording, CameraBatch& batch);
    void sendLightSamples(Recording& recording, const Paths& traced, CameraBatch& batch);
    void sumLanes(Recording& recording, uint pixels, uint lanesUsed, uint firstColumn, uint endColumn);
    void shareGathers(Recording& recording, const CameraBatch& batch);

    Gpu& gpu;
    const UploadedScene& scene;
    Settings settings;
    Features features;
    uint pixelSamples; // paths of a pixel
    bool shares;       // what gather rays bring
    uint lanes;        // paths of a pixel that are traced together
    uint gatherLanes;  // gather rays of a pixel that are
    uint batch;        // pixels wanted of one
    uint pixels;       // that one may have
    uint size;
    uint pass = 0;
    float pixelAngle = 0;
    PhotonMaps maps;
    uint rounds; // of trace and shade that a sequence of paths gets, or 0 if nobody knows yet how many it needs
    Compaction compaction;
    Buffer<Path> paths;
    Buffer<Hit> hits;
    Buffer<ShadowRay> shadowRays;
    Buffer<Query> queries;
    Buffer<Split> splits;
    Buffer<PathRounds> progress;
    Kernel<EyeArgs> eye;
    Kernel<TraceArgs> traceKernel;
    Kernel<ShadeArgs> shade;
    std::optional<Kernel<ShadowArgs>> shadow; // absent if no path asks
    std::optional<Kernel<GatherArgs>> gather;
    std::optional<Kernel<SplitArgs>> split;        // absent if paths are not split
    std::optional<Kernel<SumLanesArgs>> sum;       // absent if there is one lane
    std::optional<Kernel<ShareGathersArgs>> share; // absent if there is no global map
};

} // namespace vkpm
