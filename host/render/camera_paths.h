/// The camera pass: a wavefront of eye paths, their shadow rays and their questions to the photon maps.
#pragma once
#include "render/compaction.h"
#include "render/uploaded_scene.h"
#include "shared_camera.h"
#include "shared_guide.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <optional>

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
    const VisibleCells* marks = nullptr; // the places are marked there, and nothing is gathered
};

struct RayCounts {
    std::uint64_t paths = 0; // eye and gather rays
    std::uint64_t shadow = 0;

    RayCounts& operator+=(const RayCounts& other) { return paths += other.paths, shadow += other.shadow, *this; }
};

/// Traces one path per pixel, and gather rays from where it ends, for a range of pixels at a time.
class CameraPaths {
public:
    CameraPaths(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings, uint batch);

    /// Pixels that one call of trace() may take.
    uint capacity() const { return size; }
    /// Fills `samples` for the pixels from `first` on.
    RayCounts trace(uint pass, uint first, uint count, const PhotonMaps& maps);

    /// Where gather rays of the last range of pixels started, if paths are split.
    const Buffer<Split>& splitPoints() const { return splits; }

    Buffer<float> samples; // [column][capacity]

private:
    /// What the paths under way have in common.
    struct Batch {
        uint first; // pixel
        uint count;
        uint sequence;
        uint index; // of the sample
        const PhotonMaps& maps;
    };
    void castShadowRays(Recording& recording);
    void queryPhotonMap(Recording& recording, const Batch& batch, uint queue, const PhotonMap& map);
    void bounce(Recording& recording, const Batch& batch, uint bounce);
    RayCounts follow(Recording& recording, const Batch& batch, uint bounce);

    Gpu& gpu;
    const UploadedScene& scene;
    Settings settings;
    Features features;
    uint size;
    float pixelAngle = 0;
    Compaction compaction;
    Buffer<Path> paths;
    Buffer<Hit> hits;
    Buffer<ShadowRay> shadowRays;
    Buffer<Query> queries;
    Buffer<Split> splits;
    Kernel<EyeArgs> eye;
    Kernel<TraceArgs> traceKernel;
    Kernel<ShadeArgs> shade;
    std::optional<Kernel<ShadowArgs>> shadow; // absent if no path asks
    std::optional<Kernel<GatherArgs>> gather;
    std::optional<Kernel<SplitArgs>> split; // absent if paths are not split
};

} // namespace vkpm
