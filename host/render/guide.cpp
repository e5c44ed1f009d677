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
    settings.pixelSamples = 1;
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
    lights = axes[PRIMARY_LIGHT] && scene.lights.size() <= maxLightsLearned;
    const auto found = std::ranges::find(scene.lights, LIGHT_SKY, &Light::kind);
    if (found != scene.lights.end()) sky = static_cast<uint>(found - scene.lights.begin());
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

} // namespace vkpm
