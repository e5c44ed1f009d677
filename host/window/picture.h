/// What passes from the thread that renders to the window.
#pragma once
#include "output/statistics.h"
#include "render/error_estimate.h"
#include "scene/scene.h"

namespace vkpm {

/// A photon that is shown as a point.
struct PhotonPoint {
    vec3 position;
    vec3 color; // relative to the flux per photon
};

/// A picture after some passes, or a draft while the camera moves.
struct Picture {
    std::vector<Pixel> pixels{};
    uvec2 size{0};
    View view{};
    uint passes = 0;
    bool draft = false;
    std::vector<PhotonPoint> photons{}; // some of the maps', if they are to be shown
};

/// The estimated error after some seconds of rendering.
struct ErrorPoint {
    double seconds;
    uint passes;
    ErrorEstimate error;
};

/// How the render stands.
struct RenderState {
    Settings settings{};
    View sceneView{}; // as the scene file has it
    std::string device{};
    std::string activity = "loading";
    std::string problem{};               // of the scene file or of saving; empty if there is none
    std::vector<std::string> warnings{}; // of the scene
    std::string saved{};                 // the file that was written last
    uint saves = 0;
    uint passes = 0;
    uint passesWanted = NONE;
    double seconds = 0;
    std::uint64_t rays = 0;
    std::uint64_t photons = 0;
    std::optional<GatherRadii> globalRadii{}; // of the first pass
    std::optional<GatherRadii> causticRadii{};
    float radiusFactor = 1; // now
    std::vector<ErrorPoint> errors{};
    std::vector<std::string> leftOut{};
};

} // namespace vkpm
