/// The pilot: radii, then guides and light distribution, then radii of guided photons.
#include "render/pilot.h"
#include "render/features.h"
#include "render/light_guide.h"
#include <algorithm>
#include <array>

namespace vkpm {

/// Photons go where any layer has the eye look, so that the layers of a picture are the same whatever else was asked
/// for.
static Features withAllLayers(const Scene& scene, Settings settings) {
    settings.layers = allLayers;
    return sceneFeatures(scene, settings);
}

Pilot::Pilot(const Scene& scene, const Settings& settings)
    : needs(scene), seen(withAllLayers(scene, settings)), lightCdf(scene.lightCdf) {}

void Pilot::prepare(Gpu& gpu, UploadedScene& scene, const Features& features, const Settings& settings,
                    std::optional<PhotonMapStage>& global, std::optional<PhotonMapStage>& caustic) {
    if (!settings.guides || settings.integrator != INTEGRATOR_PHOTON) return;
    const std::array maps{&global, &caustic};
    const auto measure = [&] {
        for (std::optional<PhotonMapStage>* map : maps)
            if (*map) (*map)->measureRadii();
    };
    const auto wantsGuide = [&](const std::optional<PhotonMapStage>* map) {
        return *map && !(*map)->guide() && ((*map)->kind == MapKind::caustic || needs.global);
    };
    const bool wantsLights = (needs.lights || needs.sky) && !lightDistributionLearned && asksLights(seen, settings);
    if (wantsLights || std::ranges::any_of(maps, wantsGuide)) {
        measure();
        const CameraPilot places(gpu, scene, seen, settings,
                                 {.global = global ? global->widths() : PhotonMap{},
                                  .caustic = caustic ? caustic->widths() : PhotonMap{},
                                  .narrow = caustic ? caustic->narrowWidths() : std::vector<PhotonMap>{}});
        for (std::optional<PhotonMapStage>* map : maps)
            if (wantsGuide(map))
                (*map)->setGuide(learnGuide(gpu, scene, features, (*map)->kind, settings.seed, needs, places.marks));
        if (wantsLights) learnLights(gpu, scene, seen, settings.seed, needs, places, lightCdf);
        lightDistributionLearned = true;
    }
    measure();
}

} // namespace vkpm
