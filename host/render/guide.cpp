/// The pilot: a few paths from the eye, then rounds of photons.
#include "render/guide.h"
#include "scene/lights.h"
#include "shared_guide.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace vkpm {

const double eyePaths = 8192; // wanted
const uint maxEyePaths = 1u << 14;
const uint eyeGatherRays = 1;
const uint pointsApart = 8, maxLightsEach = 64;             // one point of so many is asked about that many lights,
const uint maxLights = 1024;                                // so that each is asked about at 64 points
const uint firstPhotons = 1u << 13, morePhotons = 1u << 15; // of the first and of other rounds
const uint maxRounds = 3;
const std::size_t enoughToTell = 30,
                  enoughPlaces = 1000; // where photons were seen: to tell whether a guide is of use, and to make it
const double minGain = 1.3;            // for which photons are guided

/// A picture of the same proportions with few pixels.
static Settings smallPicture(Settings settings) {
    const glm::dvec2 size{settings.size};
    const double scale = std::min(1.0, std::sqrt(eyePaths / (size.x * size.y)));
    settings.size = glm::max(uvec2(size * scale + 0.5), uvec2(1));
    settings.gatherRays = eyeGatherRays;
    return settings;
}

/// Cells that are just wide enough for the narrowest gathers.
static float finestCells(const PhotonMap& map) { return 2 * std::ldexp(map.radius, -static_cast<int>(map.levels)); }

CameraPilot::CameraPilot(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings,
                         const PhotonMaps& maps)
    : marks{.kernel = {gpu, "mark_visible", features}},
      paths(gpu, scene, features, smallPicture(settings), maxEyePaths) {
    Recording recording(gpu);
    for (VisibleCells::Map* map : {&marks.global, &marks.caustic}) {
        map->bits = Buffer<uint>(gpu, "eye marks", VISIBLE_CELL_WORDS + 1);
        map->cellWidth = finestCells(map == &marks.global  ? maps.global
                                     : maps.narrow.empty() ? maps.caustic
                                                           : maps.narrow.front());
        recording.clear(map->bits);
    }
    PhotonMaps marked = maps;
    marked.marks = &marks;
    CameraBatch all{.first = 0, .count = paths.capacity()};
    paths.begin(NONE, marked);
    paths.record(recording, all);
    recording.submit();
}

GuideNeeds::GuideNeeds(const Scene& scene) {
    axes.fill(true);
    axes[PRIMARY_LIGHT] = scene.lights.size() > 1;
    axes[PRIMARY_SIDE] = std::ranges::any_of(scene.lights, [](const Light& light) { return light.twoSided != 0; });
    axes[PRIMARY_TARGET] = scene.targets.size() > 1;
    middle = scene.discCount > 1;
    lights = axes[PRIMARY_LIGHT] && scene.lights.size() <= maxLights;
    global = axes[PRIMARY_LIGHT] || std::ranges::any_of(scene.lights, [&](const Light& light) {
                 return isEndless(light) || isFar(scene, light);
             });
}

Guide learnGuide(Gpu& gpu, const UploadedScene& scene, const Features& features, MapKind kind, uint seed,
                 const GuideNeeds& needs, const VisibleCells& marks) {
    const VisibleCells::Map& map = kind == MapKind::caustic ? marks.caustic : marks.global;
    const Kernel<PhotonContributionArgs> useful(gpu, "photon_contribution");
    std::array<bool, PRIMARY_DIMENSIONS> axes = needs.axes;
    axes[PRIMARY_TARGET] = kind == MapKind::caustic ? needs.axes[PRIMARY_TARGET] : needs.middle;
    Guide guide;
    std::vector<PrimarySample> all;
    for (uint round = 0; round < maxRounds && (round < 2 || guide.places.size() < enoughPlaces); round++) {
        const uint photons = round == 0 ? firstPhotons : morePhotons;
        PhotonTracing pilot(gpu, scene, features, kind, photons, seed, photons);
        const Buffer<PrimarySample> starts(gpu, "pilot starts", photons);
        pilot.guide(guide.nodes, starts);
        pilot.trace(NONE - 1 - round); // no pass of a render
        Recording recording(gpu);
        recording.run(useful, photons, {pilot.photons, pilot.places(), map.bits, starts, photons, map.cellWidth});
        recording.submit();
        for (const PrimarySample& start : starts.download()) {
            if (start.seen > 0) guide.places.push_back(start.place);
            all.push_back(start);
        }
        const GuideTree tree = guideTree(all, axes);
        const bool knows = guide.places.size() >= enoughToTell || round + 1 == maxRounds;
        if (tree.gain < minGain && knows) return {};
        guide.nodes = Buffer<GuideNode>(gpu, "guide", tree.nodes);
        guide.density = static_cast<float>(tree.density);
    }
    return guide;
}

/// Roots of the mean squares of what lights bring to a point, in parts of all light there; dim points, where nobody
/// sees noise, count less. Two answers that a light brings what its flux lets expect stand for what was not asked.
static std::vector<double> lightWeights(std::span<const float> values, std::span<const float> cdf, std::size_t each) {
    const std::size_t lights = cdf.size();
    std::vector<double> all(values.size() / each), squares(lights), asked(lights);
    double mean = 0, found = 0, expected = 0;
    for (std::size_t i = 0; i < values.size(); i++) all[i / each] += double(values[i]) * double(lights) / double(each);
    for (const double light : all) mean += light / double(all.size());
    const auto flux = [&](std::size_t light) { return double(cdf[light]) - (light > 0 ? double(cdf[light - 1]) : 0); };
    for (std::size_t i = 0; i < values.size() && mean > 0; i++) {
        const double part = values[i] / (all[i / each] + 0.1 * mean);
        squares[i % lights] += part * part;
        asked[i % lights]++;
        found += part * part;
        expected += flux(i % lights) * flux(i % lights);
    }
    std::vector<double> weights(lights);
    for (std::size_t i = 0; i < lights; i++)
        weights[i] =
            std::sqrt((squares[i] + 2 * flux(i) * flux(i) * (found > 0 ? found / expected : 1)) / (asked[i] + 2));
    return weights;
}

std::vector<float> learnLightDistribution(Gpu& gpu, const UploadedScene& scene, const Features& features, uint seed,
                                          const CameraPilot& places, std::span<const float> byFlux) {
    const uint lights = static_cast<uint>(byFlux.size()), each = std::min(lights, maxLightsEach);
    const uint points = static_cast<uint>(places.paths.splitPoints().size()) / pointsApart;
    const Buffer<float> values(gpu, "light values", std::uint64_t(points) * each);
    const Kernel<LightContributionArgs> weigh(gpu, "light_contribution", features);
    Recording recording(gpu);
    recording.run(weigh, values.size(),
                  {scene.address, places.paths.splitPoints(), values, points * each, each, pointsApart, seed});
    recording.submit();
    std::vector<float> brought = values.download();
    std::ranges::replace_if(
        brought, [](float value) { return !std::isfinite(value); }, 0.0f);
    std::vector<double> weights = lightWeights(brought, byFlux, each);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (uint i = 0; i < lights; i++)
        weights[i] = 0.9 * weights[i] / total + 0.1 * (double(byFlux[i]) - (i > 0 ? double(byFlux[i - 1]) : 0));
    return cumulative(weights);
}

} // namespace vkpm
