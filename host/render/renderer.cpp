/// Stages and their order.
#include "render/renderer.h"

namespace vkpm {

// A gather ray that ends nearer than this many radii would read the blurred corner that it comes from.
const float nearRadii = 3;

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, BatchSizes batchSizes)
    : Renderer(device, input, set, sceneFeatures(input, set), batchSizes) {}

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, const Features& features,
                   BatchSizes batchSizes)
    : gpu(device), settings(set), sceneHas(features), scene(gpu, input, settings),
      flux(glm::dot(input.flux, vec3(0.2126f, 0.7152f, 0.0722f))), batches(batchSizes),
      global(construct(MapKind::global, extentOf(input))), caustic(construct(MapKind::caustic, extentOf(input))),
      pilot(input, settings), film(gpu, settings.size, sceneHas) {
    constructCamera();
}

Features Renderer::features() const {
    Features has = sceneHas;
    has.hasGuide |= (global && global->isGuided()) || (caustic && caustic->isGuided());
    return has;
}

/// Compiles kernels while the host goes on, as long as it is there.
struct CompilingAhead {
    explicit CompilingAhead(Gpu& device) : gpu(device) { gpu.compilesAhead = true; }
    ~CompilingAhead() { gpu.compilesAhead = false; }
    CompilingAhead(const CompilingAhead&) = delete;
    CompilingAhead& operator=(const CompilingAhead&) = delete;
    Gpu& gpu;
};

/// A map with its radii, if the scene has use for it.
std::optional<PhotonMapStage> Renderer::construct(MapKind kind, const Extent& extent) {
    if (!(kind == MapKind::global ? sceneHas.hasGlobalMap : sceneHas.hasCausticMap)) return {};
    const CompilingAhead compiling(gpu); // the kernels of the map, too
    return std::optional<PhotonMapStage>(std::in_place, gpu, scene, extent, settings, sceneHas, kind, flux,
                                         batches.photons);
}

/// What depends on the size of the film. Kernels that the old one has need not be compiled for the new one.
void Renderer::constructCamera() {
    CameraPaths paths(gpu, scene, sceneHas, settings, batches.camera);
    camera.emplace(std::move(paths));
    if (!tracesLight(sceneHas, settings)) return;
    LightTracing tracing(gpu, scene, sceneHas, settings, flux, batches.photons);
    light.emplace(std::move(tracing));
}

void Renderer::setView(const View& view, uvec2 size) {
    const bool resized = size != settings.size;
    settings.size = size;
    scene.look(view, size);
    if (resized) constructCamera();
    film = Film(gpu, size, sceneHas);
    cameraRays = {};
    taken.reset();
    for (std::optional<PhotonMapStage>* map : {&global, &caustic})
        if (*map) (*map)->ledger = {}, (*map)->clearGuide();
    if (light) light->ledger = {};
    pilot.forget();
}

PhotonLedger Renderer::photons(MapKind kind) const {
    if (kind == MapKind::caustic && light) return light->ledger;
    const std::optional<PhotonMapStage>& map = kind == MapKind::caustic ? caustic : global;
    return map ? map->ledger : PhotonLedger{};
}

/// Returns what became of the photons that the map needed. Looking at a map means looking at one map: that of the first
/// pass.
PhotonLedger Renderer::buildMap(std::optional<PhotonMapStage>& map, uint pass) {
    const bool still = settings.integrator == INTEGRATOR_PHOTON_MAP;
    if (!map || (still && map->ledger.emitted > 0)) return {};
    return map->build(still ? 0 : pass);
}

/// The maps as camera paths ask them.
PhotonMaps Renderer::maps(uint pass) const {
    PhotonMaps maps;
    if (global) {
        maps.global = global->map();
        maps.nearDistance = nearRadii * global->medianRadius() * radiusFactor(pass, settings.alpha);
    }
    if (caustic) {
        maps.caustic = caustic->map();
        maps.narrow = caustic->narrowMaps();
    }
    return maps;
}

void Renderer::renderPass(uint pass) {
    pilot.prepare(gpu, scene, sceneHas, settings, global, caustic);
    const PhotonLedger ofGlobal = buildMap(global, pass), ofCaustic = buildMap(caustic, pass);
    const PhotonLedger ofLight = light ? light->trace(pass) : PhotonLedger{};
    const PhotonMaps asked = maps(pass);

    const uint pixels = settings.size.x * settings.size.y;
    if (!taken) film.begin(pass), taken = 0;
    while (*taken < pixels) {
        const uint first = *taken, count = std::min(camera->capacity(), pixels - first);
        const RayCounts rays = camera->trace(pass, first, count, asked);
        if (light) light->collect(camera->samples, camera->capacity(), first, count);
        film.add(camera->samples, camera->capacity(), first, count);
        cameraRays.paths += rays.paths;
        cameraRays.shadow += rays.shadow;
        *taken += count;
    }
    film.end();
    taken.reset();
    if (global) global->ledger += ofGlobal;
    if (caustic) caustic->ledger += ofCaustic;
    if (light) light->ledger += ofLight;
    if (sceneHas.checksFeatures) scene.requireNothingMissing();
}

} // namespace vkpm
