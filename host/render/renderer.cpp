/// Stages and their order.
#include "render/renderer.h"
#include "render/radius.h"
#include <algorithm>

namespace vkpm {

// The pass that radii are measured in. A radius for each region follows the photons there, so that they must be others than
// those of any pass of a render; one for all does not.
const uint firstPass = 0, noPass = NONE;

// Photons that say how large the scene is to its light.
const uint photonsForExtent = 8192;

// A gather ray that ends nearer than this many radii would read the blurred corner that it comes from.
const float nearRadii = 3;

// Photons that a first gather disc is to hold. Those of the global map are only seen through a gather ray, so that the noise
// of few photons averages out; caustics are looked at directly.
const float globalPhotonsPerDisc = 40;
const float causticPhotonsPerDisc = 10;

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, WaveSizes waveSizes)
    : Renderer(device, input, set, sceneFeatures(input, set), waveSizes) {}

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, const Features& features, WaveSizes waveSizes)
    : gpu(device), settings(set), sceneHas(features), scene(gpu, input, settings),
      flux(glm::dot(input.flux, vec3(0.2126f, 0.7152f, 0.0722f))),
      waves(waveSizes), global(construct(input, MapKind::global)), caustic(construct(input, MapKind::caustic)), film(gpu, settings.size, sceneHas) {
    constructCamera();
}

/// The stages of a map with its radii, if the scene has use for it.
std::optional<MapStages> Renderer::construct(const Scene& input, MapKind kind) {
    const bool isGlobal = kind == MapKind::global;
    if (!(isGlobal ? sceneHas.hasGlobalMap : sceneHas.hasCausticMap)) return {};
    const uint photons = isGlobal ? settings.photons : settings.causticPhotons;
    const std::optional<float> radius = isGlobal ? settings.radius : settings.causticRadius;
    gpu.compilesAhead = true;
    MapStages stages{PhotonTracing(gpu, scene, sceneHas, kind, photons, settings.seed, waves.photons),
                     PhotonGrid(gpu, isGlobal ? "global map" : "caustic map"), flux / float(photons), radius.value_or(0.0f)};
    if (radius) checkRadius(stages, input, isGlobal ? "--radius or /settings/radius" : "--caustic-radius or /settings/causticRadius");
    else measureRadii(stages, input, photons, isGlobal ? globalPhotonsPerDisc : causticPhotonsPerDisc, isGlobal);
    gpu.compilesAhead = false;
    return stages;
}

/// What depends on the size of the film. Kernels that the old one has need not be compiled for the new one.
void Renderer::constructCamera() {
    CameraPaths paths(gpu, scene, sceneHas, settings, waves.camera);
    camera.emplace(std::move(paths));
    if (!tracesLight(sceneHas, settings)) return;
    LightTracing tracing(gpu, scene, sceneHas, settings, flux, waves.photons);
    light.emplace(std::move(tracing));
}

void Renderer::look(const View& view, uvec2 size) {
    const bool resized = size != settings.size;
    settings.size = size;
    scene.look(view, size);
    if (resized) constructCamera();
    film = Film(gpu, size, sceneHas);
    cameraRays = {};
    for (std::optional<MapStages>* stages : {&global, &caustic})
        if (*stages) (*stages)->ledger = {};
    if (light) light->ledger = {};
}

PhotonLedger Renderer::photons(MapKind kind) const {
    if (kind == MapKind::caustic && light) return light->ledger;
    const std::optional<MapStages>& stages = kind == MapKind::caustic ? caustic : global;
    return stages ? stages->ledger : PhotonLedger{};
}

static std::vector<Photon> somePhotons(const PhotonTracing& tracing, std::uint64_t stored) {
    return tracing.photons.download(std::min<std::uint64_t>(stored, photonsForExtent));
}

/// Whether a radius that was given makes sense. Only one that drowns in the roundings of the scene's farthest coordinates has to
/// wait for photons to tell how far the light gets.
void Renderer::checkRadius(MapStages& stages, const Scene& input, std::string_view name) {
    if (!drownsInRounding(extentOf(input, {}), stages.radius)) return;
    const std::uint64_t stored = stages.tracing.trace(firstPass).stored;
    requireRadius(extentOf(input, somePhotons(stages.tracing, stored)), stages.radius, name);
}

void Renderer::measureRadii(MapStages& stages, const Scene& input, uint photons, float perDisc, bool oneRadius) {
    const bool byDensity = settings.nearest == 0 && !settings.showPoints;
    if (byDensity) stages.field.emplace(gpu);
    const uint stored = static_cast<uint>(stages.tracing.trace(oneRadius || !byDensity ? firstPass : noPass).stored);
    const Extent extent = extentOf(input, somePhotons(stages.tracing, stored));
    stages.radius = widestRadius(extent, photons, settings.nearest);
    if (!byDensity) return;
    const uint levels = mostLevels(extent, stages.radius);
    const PhotonMap pilot = stages.grid.build(stages.tracing.photons, stored, stages.radius, stages.flux, levels);
    stages.field->measure(pilot, stored, perDisc, oneRadius ? 8 : 1); // a median needs no more
    if (oneRadius) {
        stages.radius = stages.typicalRadius();
        stages.field.reset();
    }
}

void Renderer::buildMap(std::optional<MapStages>& stages, uint pass) {
    // Looking at a map means looking at one map: that of the first pass.
    const bool still = settings.integrator == INTEGRATOR_PHOTON_MAP;
    if (!stages || (still && stages->ledger.emitted > 0)) return;
    if (still) pass = 0;
    const PhotonLedger ledger = stages->tracing.trace(pass);
    stages->ledger += ledger;
    if (stages->built == pass) return;
    stages->built.reset(); // until it is done
    const float factor = radiusFactor(pass, settings.alpha);
    const float radius = settings.nearest ? stages->radius : stages->radius * factor;
    const uint levels = stages->field ? static_cast<uint>(-stages->field->smallest) : 1;
    // Points are shown as they are, and the k nearest are those of all photons.
    const std::optional<uint> thinned = settings.showPoints || settings.nearest ? std::nullopt : std::optional(pass);
    stages->map = stages->grid.build(stages->tracing.photons, static_cast<uint>(ledger.stored), radius, stages->flux, levels, thinned);
    stages->map.shrink = factor;
    stages->map.kernel = settings.kernel;
    stages->map.nearest = settings.nearest;
    if (stages->field) stages->field->apply(stages->map);
    stages->built = pass;
}

void Renderer::renderPass(uint pass) {
    buildMap(global, pass);
    buildMap(caustic, pass);
    if (light) light->trace(pass);
    const float nearDistance = global ? nearRadii * global->typicalRadius() * radiusFactor(pass, settings.alpha) : 0;
    const PhotonMaps maps{global ? global->map : PhotonMap{}, caustic ? caustic->map : PhotonMap{}, nearDistance};

    const uint pixels = settings.size.x * settings.size.y;
    film.begin(pass);
    for (uint first = 0; first < pixels; first += camera->capacity()) {
        const uint count = std::min(camera->capacity(), pixels - first);
        const RayCounts rays = camera->trace(pass, first, count, maps);
        if (light) light->collect(camera->samples, camera->capacity(), first, count);
        film.add(camera->samples, camera->capacity(), first, count);
        cameraRays.paths += rays.paths;
        cameraRays.shadow += rays.shadow;
    }
    film.end();
    if (sceneHas.checksFeatures) scene.requireNothingMissing();
}

} // namespace vkpm
