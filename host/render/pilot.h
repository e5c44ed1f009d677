/// What is learned before the first pass: where to send photons, and which lights count.
#pragma once
#include "render/photon_map.h"

namespace vkpm {

/// Learns once for a view; what it learns depends on scene, view, settings and seed alone.
class Pilot {
public:
    Pilot(const Scene& scene, const Settings& settings);

    /// Gives the maps their guides and radii, and the scene its distribution of light samples, as far as these are not
    /// known; `features` are the render's. Each is either as it was or done when a render is cancelled.
    void prepare(Gpu& gpu, UploadedScene& scene, const Features& features, const Settings& settings,
                 std::optional<PhotonMapStage>& global, std::optional<PhotonMapStage>& caustic);

    /// Another view: all is to be learned anew.
    void forget() { lightDistributionLearned = false; }

private:
    GuideNeeds needs;
    Features seen;               // were all layers asked for
    std::vector<float> lightCdf; // by flux
    bool lightDistributionLearned = false;
};

} // namespace vkpm
