/// Radii of a map, and its photons pass by pass.
#include "render/photon_map.h"
#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

namespace vkpm {

// The pass that radii are measured in. A radius for each region follows the photons there, so that they must be others
// than those of any pass of a render; one for all does not.
const uint firstPass = 0, noPass = NONE;

// Photons that say how large the scene is to its light.
const uint photonsForExtent = 8192;

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

static uint countOf(const Settings& settings, MapKind kind) {
    return kind == MapKind::global ? settings.photons : settings.causticPhotons;
}

static std::optional<float> radiusOf(const Settings& settings, MapKind kind, double unit) {
    const std::optional<float> radius = kind == MapKind::global ? settings.radius : settings.causticRadius;
    return radius ? std::optional(static_cast<float>(double{*radius} / unit)) : std::nullopt;
}

PhotonMapStage::PhotonMapStage(Gpu& device, const UploadedScene& scene, const Extent& sceneExtent, const Settings& set,
                               const Features& features, MapKind which, float allFlux, uint batch)
    : kind(which), tracing(device, scene, features, which, countOf(set, which), set.seed, batch), gpu(device),
      settings(set), extent(sceneExtent), grid(device, which == MapKind::global ? "global map" : "caustic map"),
      flux(allFlux / float(countOf(set, which))), radius(radiusOf(set, which, extent.unit).value_or(0.0f)),
      radiusIsAutomatic(!radiusOf(set, which, extent.unit)) {
    if (radiusIsAutomatic) measureRadii();
    else
        checkRadius(kind == MapKind::global ? "--radius or /settings/radius"
                                            : "--caustic-radius or /settings/causticRadius");
    radiusIsValid = true;
}

void PhotonMapStage::setGuide(Guide guide) {
    learned = std::move(guide);
    if (!isGuided()) return;
    tracing.guide(learned->nodes);
    builtPass.reset();
    radiusIsValid = !radiusIsAutomatic;
}

void PhotonMapStage::clearGuide() {
    if (isGuided()) {
        tracing.guide({});
        builtPass.reset();
        radiusIsValid = !radiusIsAutomatic;
    }
    learned.reset();
}

std::vector<vec3> PhotonMapStage::somePlaces(std::uint64_t stored) const {
    std::vector<vec3> places;
    for (const Photon& photon : tracing.photons.download(std::min<std::uint64_t>(stored, photonsForExtent)))
        places.push_back(photon.position);
    return places;
}

/// Only a radius that drowns in the roundings of the scene's farthest coordinates has to wait for photons to tell how
/// far the light gets.
void PhotonMapStage::checkRadius(std::string_view name) {
    if (!drownsInRounding(extent, radius)) return;
    const std::uint64_t stored = tracing.trace(firstPass).stored;
    requireRadius(extentOf(extent, somePlaces(stored)), radius, name);
}

void PhotonMapStage::measureRadii() {
    if (radiusIsValid) return;
    const bool oneRadius = kind == MapKind::global;
    const bool byDensity = settings.nearest == 0 && !settings.showPoints;
    if (byDensity) field.emplace(gpu);
    const uint stored = static_cast<uint>(tracing.trace(oneRadius || !byDensity ? firstPass : noPass).stored);
    const bool sees = learned && !learned->places.empty();
    const Extent lit = extentOf(extent, sees ? learned->places : somePlaces(stored));
    radius = widestRadius(lit, countOf(settings, kind), settings.nearest);
    if (byDensity) {
        const uint levels = maxLevels(lit, radius);
        const PhotonMap pilot = grid.build(tracing.photons, stored, radius, flux, levels);
        // What a guide adds to caustics goes half into less noise, half into less blur.
        const float perDisc =
            oneRadius ? globalPhotonsPerDisc : causticPhotonsPerDisc * std::sqrt(learned ? learned->density : 1.0f);
        field->measure(pilot, stored, perDisc, oneRadius ? 8 : 1); // a median needs no more
        if (oneRadius) {
            radius = medianRadius();
            field.reset();
        } else {
            measureNarrow(lit, stored, perDisc, levels);
        }
    }
    radiusIsValid = true;
}

/// Discs of caustics go as far down as their photons want.
void PhotonMapStage::measureNarrow(const Extent& lit, uint stored, float perDisc, uint levels) {
    narrow.clear();
    float overfull = field->overfull, narrowest = std::ldexp(radius, -static_cast<int>(levels));
    const auto finerLevels = [&] { return std::min(maxLevels(lit, narrowest), narrowLevels); };
    uint finer = finerLevels();
    for (; overfull > partForNarrow && finer > 0; finer = finerLevels()) {
        NarrowMap& next = narrow.emplace_back(
            NarrowMap{PhotonGrid(gpu, "narrow caustic map", narrowBlockBits), RadiusField(gpu), narrowest});
        PhotonMap map = next.grid.build(tracing.photons, stored, narrowest, flux, finer);
        map.partial = 1;
        next.field.measure(map, stored, perDisc);
        overfull = next.field.overfull;
        narrowest = std::ldexp(narrowest, -static_cast<int>(finer));
    }
    isRoundingBound = overfull > partForNarrow;
}

float PhotonMapStage::smallestRadius() const {
    if (!narrow.empty()) return narrow.back().radius * std::exp2(narrow.back().field.smallest);
    return field ? radius * std::exp2(field->smallest) : radius;
}

float PhotonMapStage::medianRadius() const {
    const auto median = std::ranges::find_if(narrow.rbegin(), narrow.rend(),
                                             [](const NarrowMap& map) { return map.field.known > 0.5f; });
    if (median != narrow.rend()) return median->radius * std::exp2(median->field.median);
    return field ? radius * std::exp2(field->median) : radius;
}

float PhotonMapStage::greatestRadius() const { return field ? radius * std::exp2(field->greatest) : radius; }

PhotonMap PhotonMapStage::widths() const {
    PhotonMap map{.levels = levels(), .radius = radius};
    if (field) field->apply(map);
    return map;
}

std::vector<PhotonMap> PhotonMapStage::narrowWidths() const {
    std::vector<PhotonMap> maps;
    for (const NarrowMap& map : narrow | std::views::reverse) {
        maps.push_back({.levels = map.levels(), .radius = map.radius});
        map.field.apply(maps.back());
    }
    return maps;
}

std::vector<PhotonMap> PhotonMapStage::narrowMaps() const {
    std::vector<PhotonMap> maps;
    for (const NarrowMap& map : narrow | std::views::reverse) maps.push_back(map.map);
    return maps;
}

void PhotonMapStage::recordCells(Recording& recording, uint pass) {
    recordedPass.reset();
    if (builtPass == pass) return;
    builtPass.reset(); // until it is done
    const float factor = radiusFactor(pass, settings.alpha);
    const auto stored = static_cast<uint>(tracing.arrived());
    const auto make = [&](PhotonGrid& cells, float widest, uint split) {
        PhotonMap map = cells.record(recording, tracing.photons, stored, widest, flux, split);
        map.shrink = factor;
        map.kernel = settings.kernel;
        map.nearest = settings.nearest;
        return map;
    };
    built = make(grid, settings.nearest ? radius : radius * factor, levels());
    if (field) field->apply(built);
    for (NarrowMap& finer : narrow) {
        finer.map = make(finer.grid, finer.radius * factor, finer.levels());
        finer.field.apply(finer.map);
    }
    recordedPass = pass;
}

// Points are shown as they are, and the k nearest are those of all photons.
void PhotonMapStage::finishCells() {
    if (!recordedPass) return;
    const auto stored = static_cast<uint>(tracing.arrived());
    if (!settings.showPoints && !settings.nearest) {
        grid.thin(tracing.photons, stored, *recordedPass);
        for (NarrowMap& finer : narrow) finer.grid.thin(tracing.photons, stored, *recordedPass);
    }
    builtPass = std::exchange(recordedPass, {});
}

} // namespace vkpm
