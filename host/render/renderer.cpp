/// Stages and their order.
#include "render/renderer.h"
#include "shared_photons.h"
#include <algorithm>
#include <ranges>

namespace vkpm {

// The pass that radii are measured in. A radius for each region follows the photons there, so that they must be others
// than those of any pass of a render; one for all does not.
const uint firstPass = 0, noPass = NONE;

// Photons that say how large the scene is to its light.
const uint photonsForExtent = 8192;

// A gather ray that ends nearer than this many radii would read the blurred corner that it comes from.
const float nearRadii = 3;

// Photons that a first gather disc is to hold. Those of the global map are only seen through a gather ray, so that the
// noise of few photons averages out; caustics are looked at directly.
const float globalPhotonsPerDisc = 40;
const float causticPhotonsPerDisc = 10;

// Part of the photons of caustics that must want discs less than half as wide as a map can have for it to get another
// of narrower ones.
const float partForNarrow = 0.1f;

// How often its cells are split at most, and bits of keys for their blocks: the few that are overfull should share keys
// with no others.
const uint narrowLevels = 3, narrowBlockBits = 11;

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, BatchSizes batchSizes)
    : Renderer(device, input, set, sceneFeatures(input, set), batchSizes) {}

/// Photons go where any layer has the eye look, so that the layers of a picture are the same whatever else was asked
/// for.
static Features withAllLayers(const Scene& scene, Settings settings) {
    settings.layers = allLayers;
    return sceneFeatures(scene, settings);
}

Renderer::Renderer(Gpu& device, const Scene& input, const Settings& set, const Features& features,
                   BatchSizes batchSizes)
    : gpu(device), settings(set), sceneHas(features), eyeHas(withAllLayers(input, set)), extent(extentOf(input)),
      guideNeeds(input), lightCdf(input.lightCdf), scene(gpu, input, settings),
      flux(glm::dot(input.flux, vec3(0.2126f, 0.7152f, 0.0722f))), batches(batchSizes),
      global(construct(MapKind::global)), caustic(construct(MapKind::caustic)), film(gpu, settings.size, sceneHas) {
    constructCamera();
}

Features Renderer::features() const {
    Features has = sceneHas;
    for (const std::optional<MapStages>* stages : {&global, &caustic})
        if (*stages && (*stages)->guide && (*stages)->guide->nodes.size()) has.hasGuide = 1;
    return has;
}

/// The stages of a map with its radii, if the scene has use for it.
std::optional<MapStages> Renderer::construct(MapKind kind) {
    const bool isGlobal = kind == MapKind::global;
    if (!(isGlobal ? sceneHas.hasGlobalMap : sceneHas.hasCausticMap)) return {};
    const uint photons = isGlobal ? settings.photons : settings.causticPhotons;
    std::optional<float> radius = isGlobal ? settings.radius : settings.causticRadius;
    if (radius) *radius = static_cast<float>(double{*radius} / extent.unit);
    gpu.compilesAhead = true;
    MapStages stages{kind,
                     PhotonTracing(gpu, scene, sceneHas, kind, photons, settings.seed, batches.photons),
                     PhotonGrid(gpu, isGlobal ? "global map" : "caustic map"),
                     flux / float(photons),
                     radius.value_or(0.0f),
                     !radius};
    if (radius)
        checkRadius(stages, isGlobal ? "--radius or /settings/radius" : "--caustic-radius or /settings/causticRadius");
    else measureRadii(stages);
    stages.measured = true;
    gpu.compilesAhead = false;
    return stages;
}

/// What depends on the size of the film. Kernels that the old one has need not be compiled for the new one.
void Renderer::constructCamera() {
    CameraPaths paths(gpu, scene, sceneHas, settings, batches.camera);
    camera.emplace(std::move(paths));
    if (!tracesLight(sceneHas, settings)) return;
    LightTracing tracing(gpu, scene, sceneHas, settings, flux, batches.photons);
    light.emplace(std::move(tracing));
}

void Renderer::look(const View& view, uvec2 size) {
    const bool resized = size != settings.size;
    settings.size = size;
    scene.look(view, size);
    if (resized) constructCamera();
    film = Film(gpu, size, sceneHas);
    cameraRays = {};
    taken.reset();
    for (std::optional<MapStages>* stages : {&global, &caustic})
        if (*stages) (*stages)->ledger = {}, (*stages)->forget();
    if (light) light->ledger = {};
    lightDistributionLearned = false;
}

PhotonLedger Renderer::photons(MapKind kind) const {
    if (kind == MapKind::caustic && light) return light->ledger;
    const std::optional<MapStages>& stages = kind == MapKind::caustic ? caustic : global;
    return stages ? stages->ledger : PhotonLedger{};
}

static std::vector<vec3> somePlaces(const PhotonTracing& tracing, std::uint64_t stored) {
    std::vector<vec3> places;
    for (const Photon& photon : tracing.photons.download(std::min<std::uint64_t>(stored, photonsForExtent)))
        places.push_back(photon.position);
    return places;
}

/// Whether a radius that was given makes sense. Only one that drowns in the roundings of the scene's farthest
/// coordinates has to wait for photons to tell how far the light gets.
void Renderer::checkRadius(MapStages& stages, std::string_view name) {
    if (!drownsInRounding(extent, stages.radius)) return;
    const std::uint64_t stored = stages.tracing.trace(firstPass).stored;
    requireRadius(extentOf(extent, somePlaces(stages.tracing, stored)), stages.radius, name);
}

/// The radii of photons as they are started now. What the eye does not see is of no account, if it is known.
void Renderer::measureRadii(MapStages& stages) {
    const bool oneRadius = stages.kind == MapKind::global;
    const bool byDensity = settings.nearest == 0 && !settings.showPoints;
    if (byDensity) stages.field.emplace(gpu);
    const uint stored = static_cast<uint>(stages.tracing.trace(oneRadius || !byDensity ? firstPass : noPass).stored);
    const bool sees = stages.guide && !stages.guide->places.empty();
    const Extent lit = extentOf(extent, sees ? stages.guide->places : somePlaces(stages.tracing, stored));
    stages.radius = widestRadius(lit, oneRadius ? settings.photons : settings.causticPhotons, settings.nearest);
    if (!byDensity) return;
    const uint levels = maxLevels(lit, stages.radius);
    const PhotonMap pilot = stages.grid.build(stages.tracing.photons, stored, stages.radius, stages.flux, levels);
    // What a guide adds to caustics goes half into less noise, half into less blur.
    const float perDisc = oneRadius ? globalPhotonsPerDisc
                                    : causticPhotonsPerDisc * std::sqrt(stages.guide ? stages.guide->density : 1.0f);
    stages.field->measure(pilot, stored, perDisc, oneRadius ? 8 : 1); // a median needs no more
    if (oneRadius) {
        stages.radius = stages.medianRadius();
        stages.field.reset();
        return;
    }

    // Discs of caustics go as far down as their photons want.
    stages.narrow.clear();
    float overfull = stages.field->overfull, narrowest = std::ldexp(stages.radius, -static_cast<int>(levels));
    const auto finerLevels = [&] { return std::min(maxLevels(lit, narrowest), narrowLevels); };
    uint finer = finerLevels();
    for (; overfull > partForNarrow && finer > 0; finer = finerLevels()) {
        NarrowMap& next = stages.narrow.emplace_back(
            NarrowMap{PhotonGrid(gpu, "narrow caustic map", narrowBlockBits), RadiusField(gpu), narrowest});
        PhotonMap map = next.grid.build(stages.tracing.photons, stored, narrowest, stages.flux, finer);
        map.partial = 1;
        next.field.measure(map, stored, perDisc);
        overfull = next.field.overfull;
        narrowest = std::ldexp(narrowest, -static_cast<int>(finer));
    }
    stages.roundingBinds = overfull > partForNarrow;
}

float MapStages::medianRadius() const {
    const auto typical = std::ranges::find_if(narrow.rbegin(), narrow.rend(),
                                              [](const NarrowMap& map) { return map.field.known > 0.5f; });
    if (typical != narrow.rend()) return typical->radius * std::exp2(typical->field.median);
    return field ? radius * std::exp2(field->median) : radius;
}

float MapStages::smallestRadius() const {
    if (!narrow.empty()) return narrow.back().radius * std::exp2(narrow.back().field.smallest);
    return field ? radius * std::exp2(field->smallest) : radius;
}

/// A map as gathers see it, but for its photons.
static PhotonMap mapOf(const std::optional<MapStages>& stages) {
    if (!stages) return {};
    PhotonMap map{.levels = stages->levels(), .radius = stages->radius};
    if (stages->field) stages->field->apply(map);
    return map;
}

/// The maps of narrow discs, but for their photons, the narrowest first.
static std::vector<PhotonMap> narrowMapsOf(const std::optional<MapStages>& stages) {
    std::vector<PhotonMap> maps;
    if (!stages) return maps;
    for (const NarrowMap& narrow : stages->narrow | std::views::reverse) {
        maps.push_back({.levels = narrow.levels(), .radius = narrow.radius});
        narrow.field.apply(maps.back());
    }
    return maps;
}

/// Learns where to send photons, once for a view. Each stage is either as it was or done when a render is cancelled.
void Renderer::guidePhotons() {
    if (!settings.guides || settings.integrator != INTEGRATOR_PHOTON) return;
    const std::array maps{&global, &caustic};
    const auto measure = [&] {
        for (std::optional<MapStages>* stages : maps) {
            if (!*stages || (*stages)->measured) continue;
            measureRadii(**stages);
            (*stages)->measured = true;
        }
    };
    const auto learns = [&](const std::optional<MapStages>* stages) {
        return *stages && !(*stages)->guide && ((*stages)->kind == MapKind::caustic || guideNeeds.global);
    };
    const bool weighs = guideNeeds.lights && !lightDistributionLearned && asksLights(eyeHas, settings);
    if (weighs || std::ranges::any_of(maps, learns)) {
        measure();
        const CameraPilot places(gpu, scene, eyeHas, settings, {mapOf(global), mapOf(caustic), narrowMapsOf(caustic)});
        for (std::optional<MapStages>* stages : maps)
            if (learns(stages))
                (*stages)->follow(
                    learnGuide(gpu, scene, sceneHas, (*stages)->kind, settings.seed, guideNeeds, places.marks));
        if (weighs) scene.chooseLights(learnLightDistribution(gpu, scene, eyeHas, settings.seed, places, lightCdf));
        lightDistributionLearned = true;
    }
    measure();
}

void MapStages::follow(Guide learned) {
    guide = std::move(learned);
    if (!guide->nodes.size()) return;
    tracing.guide(guide->nodes);
    built.reset();
    measured = !chooses;
}

void MapStages::forget() {
    if (guide && guide->nodes.size()) {
        tracing.guide({});
        built.reset();
        measured = !chooses;
    }
    guide.reset();
}

/// Returns what became of the photons that the map needed.
PhotonLedger Renderer::buildMap(std::optional<MapStages>& stages, uint pass) {
    // Looking at a map means looking at one map: that of the first pass.
    const bool still = settings.integrator == INTEGRATOR_PHOTON_MAP;
    if (!stages || (still && stages->ledger.emitted > 0)) return {};
    if (still) pass = 0;
    const PhotonLedger ledger = stages->tracing.trace(pass);
    if (stages->built == pass) return ledger;
    stages->built.reset(); // until it is done
    const float factor = radiusFactor(pass, settings.alpha);
    const float radius = settings.nearest ? stages->radius : stages->radius * factor;
    // Points are shown as they are, and the k nearest are those of all photons.
    const std::optional<uint> thinned = settings.showPoints || settings.nearest ? std::nullopt : std::optional(pass);
    stages->map = stages->grid.build(stages->tracing.photons, static_cast<uint>(ledger.stored), radius, stages->flux,
                                     stages->levels(), thinned);
    stages->map.shrink = factor;
    stages->map.kernel = settings.kernel;
    stages->map.nearest = settings.nearest;
    if (stages->field) stages->field->apply(stages->map);
    for (NarrowMap& narrow : stages->narrow) {
        narrow.map = narrow.grid.build(stages->tracing.photons, static_cast<uint>(ledger.stored),
                                       narrow.radius * factor, stages->flux, narrow.levels(), thinned);
        narrow.map.kernel = settings.kernel;
        narrow.map.shrink = factor;
        narrow.field.apply(narrow.map);
    }
    stages->built = pass;
    return ledger;
}

void Renderer::renderPass(uint pass) {
    guidePhotons();
    const PhotonLedger ofGlobal = buildMap(global, pass), ofCaustic = buildMap(caustic, pass);
    const PhotonLedger ofLight = light ? light->trace(pass) : PhotonLedger{};
    const float nearDistance = global ? nearRadii * global->medianRadius() * radiusFactor(pass, settings.alpha) : 0;
    PhotonMaps maps{.global = global ? global->map : PhotonMap{},
                    .caustic = caustic ? caustic->map : PhotonMap{},
                    .nearDistance = nearDistance};
    if (caustic)
        for (const NarrowMap& narrow : caustic->narrow | std::views::reverse) maps.narrow.push_back(narrow.map);

    const uint pixels = settings.size.x * settings.size.y;
    if (!taken) film.begin(pass), taken = 0;
    while (*taken < pixels) {
        const uint first = *taken, count = std::min(camera->capacity(), pixels - first);
        const RayCounts rays = camera->trace(pass, first, count, maps);
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
