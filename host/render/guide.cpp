/// The pilot: a few paths from the eye, then rounds of photons.
#include "render/guide.h"
#include "scene/lights.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

const double eyePaths = 8192;
const uint eyeGatherRays = 1;
const uint firstPhotons = 1u << 13, morePhotons = 1u << 15; // of the first and of other rounds
const uint mostRounds = 4;
const std::size_t enoughToTell = 30, enoughPlaces = 1000; // where photons were seen: to tell whether a guide is of use, and to make it
const double leastGain = 1.3; // for which photons are guided

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

EyePlaces::EyePlaces(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings, const PhotonMaps& maps)
    : marks{.kernel = {gpu, "mark", features}} {
    Recording recording(gpu);
    for (EyeMarks::Map* map : {&marks.global, &marks.caustic}) {
        map->bits = Buffer<uint>(gpu, "eye marks", MARK_WORDS + 1);
        map->cellWidth = finestCells(map == &marks.global ? maps.global : maps.caustic);
        recording.clear(map->bits);
    }
    recording.submit();
    const Settings small = smallPicture(settings);
    CameraPaths paths(gpu, scene, features, small, small.size.x * small.size.y);
    PhotonMaps marked = maps;
    marked.marks = &marks;
    paths.trace(NONE, 0, paths.capacity(), marked);
}

GuideNeeds::GuideNeeds(const Scene& scene) {
    axes.fill(true);
    axes[START_LIGHT] = scene.lights.size() > 1;
    axes[START_SIDE] = std::ranges::any_of(scene.lights, [](const Light& light) { return light.twoSided != 0; });
    axes[START_TARGET] = scene.targets.size() > 1;
    global = axes[START_LIGHT] || std::ranges::any_of(scene.lights, [&](const Light& light) { return isFar(scene, light); });
}

Guide learnGuide(Gpu& gpu, const UploadedScene& scene, const Features& features, MapKind kind, uint seed, const GuideNeeds& needs, const EyeMarks& marks) {
    const EyeMarks::Map& map = kind == MapKind::caustic ? marks.caustic : marks.global;
    const Kernel<UsefulArgs> useful(gpu, "useful");
    std::array<bool, START_NUMBERS> axes = needs.axes;
    axes[START_TARGET] &= kind == MapKind::caustic;
    Guide guide;
    std::vector<Start> all;
    for (uint round = 0; round < mostRounds && (round < 2 || guide.places.size() < enoughPlaces); round++) {
        const uint photons = round == 0 ? firstPhotons : morePhotons;
        PhotonTracing pilot(gpu, scene, features, kind, photons, seed, photons);
        const Buffer<Start> starts(gpu, "pilot starts", photons);
        pilot.guide(guide.nodes, starts);
        pilot.trace(NONE - 1 - round); // no pass of a render
        Recording recording(gpu);
        recording.run(useful, photons, {pilot.photons, pilot.places(), map.bits, starts, photons, map.cellWidth});
        recording.submit();
        for (const Start& start : starts.download()) {
            if (start.seen > 0) guide.places.push_back(start.place);
            all.push_back(start);
        }
        const GuideTree tree = guideTree(all, axes);
        const bool knows = guide.places.size() >= enoughToTell || round + 1 == mostRounds;
        if (tree.gain < leastGain && knows) return {};
        guide.nodes = Buffer<GuideNode>(gpu, "guide", tree.nodes);
        guide.density = static_cast<float>(tree.density);
    }
    return guide;
}

} // namespace vkpm
