/// The renderer: decides which stages a scene needs and what runs when.
#pragma once
#include "render/camera_paths.h"
#include "render/features.h"
#include "render/film.h"
#include "render/light_tracing.h"
#include "render/photon_map.h"
#include "render/pilot.h"
#include <optional>

namespace vkpm {

/// How many paths are under way at a time, and rounds that those from the eye get at first, if that is not to be found
/// out; the picture does not depend on it.
struct BatchSizes {
    uint photons = 1u << 17;
    uint camera = 1u << 19;
    uint rounds = 0;
};

/// What passes made the device and the host do.
struct Work {
    std::uint64_t waits = 0; // of the host for the device
    std::uint64_t dispatches = 0;
};

/// Renders a scene pass by pass into its film; pass i is a pure function of (scene, settings, i).
class Renderer {
public:
    Renderer(Gpu& gpu, const Scene& scene, const Settings& settings, BatchSizes batches = {});
    /// With other features than sceneFeatures(scene, settings), for tests.
    Renderer(Gpu& gpu, const Scene& scene, const Settings& settings, const Features& features, BatchSizes batches = {});

    /// Renders the pass of an index, the one after the film's last. After Cancelled it goes on where that pass was
    /// left.
    void renderPass(uint pass);

    /// Begins anew with another view and size; photon maps do not depend on these and stay; a pass under way is
    /// forgotten.
    void setView(const View& view, uvec2 size);

    RayCounts rays() const { return cameraRays; }
    /// How often a path entered a fifth medium at a time, counted up to 2^32.
    uint mediaOverflows() const { return scene.mediaOverflows(); }
    /// Of all passes; what is learned before the first one is not in it.
    const Work& work() const { return passWork; }
    /// What the kernels are made for; guides once a pass was rendered.
    Features features() const;
    const std::optional<PhotonMapStage>& globalMap() const { return global; }
    const std::optional<PhotonMapStage>& causticMap() const { return caustic; }
    /// What became of the photons of either kind in all passes; those of the caustic kind are for its map or for light
    /// tracing.
    PhotonLedger photons(MapKind kind) const;

private:
    std::optional<PhotonMapStage> construct(MapKind kind, const Extent& extent);
    void constructCamera();
    void buildMaps(Recording& recording, uint pass);
    void tracePaths(Recording& recording, uint pass);
    PhotonMaps maps(uint pass) const;

    Gpu& gpu;
    Settings settings;
    Features sceneHas;
    UploadedScene scene;
    float flux; // luminance of the lights' flux, W
    BatchSizes batches;
    std::optional<PhotonMapStage> global;
    std::optional<PhotonMapStage> caustic;
    Pilot pilot;
    std::optional<LightTracing> light;
    std::optional<CameraPaths> camera;
    RayCounts cameraRays;
    std::vector<CameraBatch> underWay; // all of a pass
    std::size_t submitted = 0;         // of these
    Work passWork;

public:
    Film film;
};

} // namespace vkpm
