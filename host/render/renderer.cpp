/// Stages and their order.
#include "render/renderer.h"
#include "scene/luminance.h"

namespace vkpm {

// A gather ray that ends nearer than this many radii would read the blurred corner that it comes from.
const float nearRadii = 3;

// What gather rays bring varies less from place to place than photons do: it is shared this many radii around.
const float sharingRadii = 2;

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, BatchSizes batchSizes)
    : Renderer(device, input, set, sceneFeatures(input, set), batchSizes) {}

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, const Features& features,
                   BatchSizes batchSizes)
    : gpu(device), settings(set), sceneHas(features), scene(gpu, input, settings), flux(luminance(input.flux)),
      batches(batchSizes), global(construct(MapKind::global, extentOf(input))),
      caustic(construct(MapKind::caustic, extentOf(input))), pilot(input, settings),
      film(gpu, settings.size, sceneHas) {
    constructCamera();
}

Features Renderer::features() const {
    Features has = sceneHas;
    has.hasGuide |= (global && global->isGuided()) || (caustic && caustic->isGuided());
    has.hasLightGuide &= scene.guidesLights();
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
    CameraPaths paths(gpu, scene, sceneHas, settings, batches.camera, batches.rounds);
    camera.emplace(std::move(paths));
    if (!tracesLight(sceneHas, settings)) return;
    LightTracing tracing(gpu, scene, sceneHas, settings, flux, batches.photons);
    light.emplace(std::move(tracing));
}

void Renderer::setView(const View& view, uvec2 size) {
    const bool resized = size != settings.size;
    settings.size = size;
    scene.setView(view, size);
    if (resized) constructCamera();
    film = Film(gpu, size, sceneHas);
    cameraRays = {};
    underWay.clear();
    submitted = 0;
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

/// Photons of all kinds, which the host has to count before it can sort them, and their cells and splats. Looking at a
/// map means looking at one map: that of the first pass.
void Renderer::buildMaps(Recording& recording, uint pass) {
    const uint shown = settings.integrator == INTEGRATOR_PHOTON_MAP ? 0 : pass;
    std::vector<PhotonTracing*> tracings;
    for (std::optional<PhotonMapStage>* map : {&global, &caustic})
        if (*map) tracings.push_back(&(*map)->tracing);
    const std::size_t maps = tracings.size();
    if (light) tracings.push_back(&light->tracing);
    for (bool finished = false; !finished;) {
        for (std::size_t i = 0; i < tracings.size(); i++) tracings[i]->record(recording, i < maps ? shown : pass);
        recording.submit();
        finished = true;
        for (PhotonTracing* tracing : tracings) finished &= tracing->finish();
    }

    for (std::optional<PhotonMapStage>* map : {&global, &caustic})
        if (*map) (*map)->recordCells(recording, shown);
    if (light) light->recordSplats(recording, pass);
    recording.submit();
    for (std::optional<PhotonMapStage>* map : {&global, &caustic})
        if (*map) (*map)->finishCells();
}

/// The maps as camera paths ask them.
PhotonMaps Renderer::maps(uint pass) const {
    PhotonMaps maps;
    if (global) {
        maps.global = global->map();
        const float radius = global->medianRadius() * radiusFactor(pass, settings.alpha);
        maps.sharingRadius = sharingRadii * radius;
        maps.nearDistance = nearRadii * radius;
    }
    if (caustic) {
        maps.caustic = caustic->map();
        maps.narrow = caustic->narrowMaps();
    }
    return maps;
}

/// The paths of a pass, a batch after the other, into the film. While the device works on one the host records the
/// next.
void Renderer::tracePaths(Recording& recording, uint pass) {
    if (underWay.empty()) underWay = camera->batches(pass);
    camera->begin(pass, maps(pass));
    if (submitted == 0) film.begin(recording, pass);
    const auto record = [&](CameraBatch& batch) {
        camera->record(recording, batch);
        if (light) light->recordSums(recording, camera->samples, camera->capacity(), batch.first, batch.count);
        film.add(recording, camera->samples, camera->capacity(), batch.first, batch.count, camera->unfinished());
    };
    try {
        for (; submitted < underWay.size(); submitted++) {
            record(underWay[submitted]);
            recording.flush();
        }
    } catch (const Cancelled&) {
        recording.wait(); // for what was submitted, which will not be done again
        throw;
    }
    recording.wait();
    for (CameraBatch& batch : underWay)
        while (!camera->finish(batch)) {
            CameraBatch again{.first = batch.first, .count = batch.count};
            record(again);
            recording.submit();
            batch = again;
        }
}

void Renderer::renderPass(uint pass) {
    pilot.prepare(gpu, scene, sceneHas, settings, global, caustic);
    const Work before{gpu.waits, gpu.dispatches};
    Recording recording(gpu);
    buildMaps(recording, pass);
    tracePaths(recording, pass);
    film.end();
    for (const CameraBatch& batch : underWay) cameraRays += batch.rays();
    underWay.clear();
    submitted = 0;
    const bool still = settings.integrator == INTEGRATOR_PHOTON_MAP;
    for (std::optional<PhotonMapStage>* map : {&global, &caustic})
        if (*map && !(still && (*map)->ledger.emitted > 0)) (*map)->ledger += (*map)->tracing.ledger();
    if (light) light->ledger += light->passLedger();
    passWork.waits += gpu.waits - before.waits;
    passWork.dispatches += gpu.dispatches - before.dispatches;
    if (sceneHas.checksFeatures) scene.requireNothingMissing();
}

} // namespace vkpm
