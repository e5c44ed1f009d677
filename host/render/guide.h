/// Sends photons where the eye looks.
#pragma once
#include "render/camera_paths.h"
#include "render/guide_tree.h"
#include "render/photon_tracing.h"
#include "shared_photons.h"
#include <optional>

namespace vkpm {

/// Where some paths from the eye ask the photon maps, as sets of cells about as wide as what is read there.
class CameraPilot {
public:
    /// Follows some paths of a small picture with the camera of `scene`; `maps` say how wide gathers are.
    CameraPilot(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings,
                const PhotonMaps& maps);

    VisibleCells marks;
    CameraPaths paths;
};

const uint maxLightsLearned = 1024; // of more, light samples choose by flux

/// What of guiding a scene can make use of.
struct GuideNeeds {
    explicit GuideNeeds(const Scene& scene);

    std::array<bool, PRIMARY_DIMENSIONS> axes; // numbers that matter
    bool global;             // photons of the global map, which go everywhere if there is one lamp and it is near
    bool middle;             // whether the global map's are aimed at the middle, too
    bool lights;             // light samples, if there are lights to choose from
    std::optional<uint> sky; // light, of which light samples choose directions
};

/// What was learned of the photons of a map.
struct Guide {
    Buffer<GuideNode>
        nodes; // none: photons are started uniformly, as nearly all come to lie where the eye looks, or none does
    std::vector<vec3> places; // of photons that the eye sees
    float density = 1;        // how many more of them there are than of uniform ones
};

/// Learns in some rounds which photons to start, each with the guide of those before; stops after the first if there is
/// little to gain.
Guide learnGuide(Gpu& gpu, const UploadedScene& scene, const Features& features, MapKind kind, uint seed,
                 const GuideNeeds& needs, const VisibleCells& marks);

} // namespace vkpm
