/// Stages and their order.
#include "render/renderer.h"
#include "render/radius.h"
#include <algorithm>

namespace vkpm {

static bool needsGlobal(const Settings& settings) {
    return settings.integrator == INTEGRATOR_PHOTON || (settings.integrator == INTEGRATOR_PHOTON_MAP && !settings.showCaustic);
}

static bool needsCaustic(const Settings& settings, const Features& has) {
    const bool wanted = settings.integrator == INTEGRATOR_PHOTON || (settings.integrator == INTEGRATOR_PHOTON_MAP && settings.showCaustic);
    return wanted && (has.hasMirror || has.hasGlass);
}

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, WaveSizes waves)
    : gpu(device), settings(set), sceneHas(sceneFeatures(input, settings)), scene(gpu, input, settings.size),
      flux(glm::dot(input.flux, vec3(0.2126f, 0.7152f, 0.0722f))),
      camera(gpu, scene, sceneHas, settings, needsCaustic(settings, sceneHas), waves.camera), film(gpu, settings.size) {
    const auto construct = [&](std::optional<MapStages>& stages, MapKind kind, uint photons) {
        const char* name = kind == MapKind::caustic ? "caustic map" : "global map";
        stages.emplace(MapStages{PhotonTracing(gpu, scene, sceneHas, kind, photons, settings.seed, waves.photons), PhotonGrid(gpu, name)});
    };
    if (needsGlobal(settings) && settings.photons > 0) construct(global, MapKind::global, settings.photons);
    else absent.push_back(settings.photons ? "global map: the integrator does not use it" : "global map: no photons asked for");
    if (needsCaustic(settings, sceneHas) && settings.causticPhotons > 0) construct(caustic, MapKind::caustic, settings.causticPhotons);
    else if (!sceneHas.hasMirror && !sceneHas.hasGlass) absent.push_back("caustic map: no specular surface");
    else absent.push_back(settings.causticPhotons ? "caustic map: the integrator does not use it" : "caustic map: no photons asked for");
}

void Renderer::buildMap(std::optional<MapStages>& stages, uint pass, uint photons, float radius) {
    // Looking at a map means looking at one map: that of the first pass.
    const bool still = settings.integrator == INTEGRATOR_PHOTON_MAP;
    if (!stages || (still && stages->ledger.emitted > 0)) return;
    if (still) pass = 0;
    const PhotonLedger ledger = stages->tracing.trace(pass);
    radius *= radiusFactor(pass, settings.alpha);
    stages->map = stages->grid.build(stages->tracing.photons, static_cast<uint>(ledger.stored), radius, flux / float(photons));
    stages->ledger += ledger;
}

void Renderer::renderPass(uint pass) {
    buildMap(global, pass, settings.photons, *settings.radius);
    buildMap(caustic, pass, settings.causticPhotons, *settings.causticRadius);
    const PhotonMaps maps{global ? global->map : PhotonMap{}, caustic ? caustic->map : PhotonMap{}};

    const uint pixels = settings.size.x * settings.size.y;
    film.begin(pass);
    for (uint first = 0; first < pixels; first += camera.capacity()) {
        const uint count = std::min(camera.capacity(), pixels - first);
        const RayCounts rays = camera.trace(pass, first, count, maps);
        film.add(camera.samples, first, count);
        cameraRays.paths += rays.paths;
        cameraRays.shadow += rays.shadow;
    }
    film.end();
}

} // namespace vkpm
