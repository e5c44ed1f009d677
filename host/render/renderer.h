/// The renderer: decides which stages a scene needs and what runs when.
#pragma once
#include "render/camera_paths.h"
#include "render/features.h"
#include "render/film.h"
#include "render/guide.h"
#include "render/light_tracing.h"
#include "render/photon_grid.h"
#include "render/photon_tracing.h"
#include "render/radius.h"
#include "render/radius_field.h"
#include "shared_photons.h"
#include <cmath>
#include <optional>

namespace vkpm {

/// The photons of a map once more, in cells for discs narrower than its own. It answers where most photons want such
/// discs.
struct NarrowMap {
    PhotonGrid grid;
    RadiusField field;
    float radius; // of the first pass, the widest
    PhotonMap map{};

    uint levels() const { return static_cast<uint>(-field.smallest); }
};

/// A photon map that is made anew for each pass.
struct MapStages {
    MapKind kind;
    PhotonTracing tracing;
    PhotonGrid grid;
    float flux;                         // W per photon
    float radius;                       // of the first pass, the widest
    bool chooses;                       // whether the program chooses it
    std::optional<RadiusField> field{}; // where it is less, if the program chooses
    std::vector<NarrowMap> narrow{};    // where it is less than the cells of one map can be, the narrowest last
    bool roundingBinds = false;         // whether discs would be narrower still but for the rounding of coordinates
    bool measured = false;              // whether radii are those of the photons now
    std::optional<Guide> guide{};       // once it is learned
    PhotonLedger ledger{};
    PhotonMap map{};
    std::optional<uint> built{}; // pass whose map this is

    /// That of most photons in the first pass.
    float medianRadius() const;
    /// The least one in the first pass.
    float smallestRadius() const;
    /// How often cells are split for the narrowest radii, but for those of narrow maps.
    uint levels() const { return field ? static_cast<uint>(-field->smallest) : 1; }

    /// Starts photons by a guide from now on.
    void follow(Guide learned);
    /// Starts photons as if the guide were not learned yet.
    void forget();
};

/// How many paths are under way at a time; the picture does not depend on it.
struct BatchSizes {
    uint photons = 1u << 17;
    uint camera = 1u << 17;
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
    void look(const View& view, uvec2 size);

    RayCounts rays() const { return cameraRays; }
    /// What the kernels are made for; hasGuide once a pass was rendered.
    Features features() const;
    const std::optional<MapStages>& globalMap() const { return global; }
    const std::optional<MapStages>& causticMap() const { return caustic; }
    /// What became of the photons of either kind in all passes; those of the caustic kind are for its map or for light
    /// tracing.
    PhotonLedger photons(MapKind kind) const;

private:
    std::optional<MapStages> construct(MapKind kind);
    void checkRadius(MapStages& stages, std::string_view name);
    void measureRadii(MapStages& stages);
    void guidePhotons();
    void constructCamera();
    PhotonLedger buildMap(std::optional<MapStages>& stages, uint pass);

    Gpu& gpu;
    Settings settings;
    Features sceneHas;
    Features eyeHas; // were all layers asked for
    Extent extent;
    GuideNeeds guideNeeds;
    std::vector<float> lightCdf;           // by flux
    bool lightDistributionLearned = false; // whether it is known which lights count, see learnLightDistribution
    UploadedScene scene;
    float flux; // luminance of the lights' flux, W
    BatchSizes batches;
    std::optional<MapStages> global;
    std::optional<MapStages> caustic;
    std::optional<LightTracing> light;
    std::optional<CameraPaths> camera;
    RayCounts cameraRays;
    std::optional<uint> taken; // pixels of the pass under way that the film has

public:
    Film film;
};

} // namespace vkpm
