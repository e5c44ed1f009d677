/// What passes between the window and the thread that renders.
#pragma once
#include "job/options.h"
#include "output/statistics.h"
#include "render/error_estimate.h"
#include "scene/scene.h"
#include <memory>

namespace vkpm {

/// What the window asks of the thread, which sees to it as soon as it can.
struct RenderRequest {
    SettingsOptions settings{}; // over the scene's
    std::optional<View> view{}; // absent: the scene's
    bool moving = false;        // previews of the view, until it rests
    bool paused = false;
    bool photons = false; // pictures come with photons
    uint reloads = 0;     // how often the scene's file has changed,
    uint saves = 0;       // and a file was asked for
    bool close = false;
    bool discard = false; // without saving

    bool operator==(const RenderRequest&) const = default;
};

/// A photon that is shown as a point.
struct PhotonPoint {
    vec3 position;
    vec3 color; // relative to the flux per photon
};

/// A picture after some passes, or a preview while the camera moves.
struct Picture {
    std::vector<Pixel> pixels{};
    uvec2 size{0};
    View view{};
    uint passes = 0;
    bool preview = false;
    std::vector<PhotonPoint> photons{}; // some of the maps', if they are to be shown
};

/// The estimated error after some seconds of rendering.
struct ErrorPoint {
    double seconds;
    uint passes;
    ErrorEstimate error;
};

/// What the thread is doing: `preparing` is the first preview and compiling, `stopped` is after a failure.
enum class Activity { loading, preparing, moving, rendering, paused, done, stopped };
inline constexpr std::array activityNames{"loading", "preparing", "moving", "rendering", "paused", "done", "stopped"};

/// How the render stands.
struct RenderState {
    std::shared_ptr<const Picture> picture{}; // the newest; null before the first
    Settings settings{};
    View sceneView{}; // as the scene file has it
    Activity activity = Activity::loading;
    std::string problem{};               // of the scene file; empty if there is none
    std::string refusal{};               // why the request cannot be rendered
    std::vector<std::string> warnings{}; // of the scene
    std::string saved{};                 // the file that was written last, or why it was not
    uint passes = 0;
    uint passesWanted = NONE;
    double seconds = 0;
    std::uint64_t rays = 0;
    std::uint64_t photons = 0;
    std::optional<GatherRadii> globalRadii{}; // of the first pass
    std::optional<GatherRadii> causticRadii{};
    float radiusFactor = 1; // now
    std::vector<ErrorPoint> errors{};
    std::optional<double> targetError{}; // to stop at
    std::vector<std::string> leftOut{};
};

} // namespace vkpm
