/// The panel beside the picture: how the render stands, and what may be changed.
#pragma once
#include "job/options.h"
#include "window/controls.h"
#include "window/picture.h"

namespace vkpm {

/// What the panel shows of the window's own.
struct PanelInput {
    const RenderState& state;
    const Picture* picture;   // null before the first
    double draftsPerSecond;   // while the camera moves
    const std::string& about; // what was done last
    float scale;
    ivec2 window;
};

/// What it changes.
struct PanelChoices {
    Tone tone{};
    bool photons = false;
    bool follows = false; // the film has the size of the window
    bool paused = false;
    bool looksAbout = false;
    RenderOptions options{};
    std::vector<Action> actions{};
};

/// Its width in the window's pixels.
int panelWidth(float scale);

/// Draws it with ImGui at the right edge of the window.
void drawPanel(const PanelInput& input, PanelChoices& choices);

/// Draws the estimated error over seconds, both logarithmic, into what is left of the panel's width.
void drawErrorCurve(const std::vector<ErrorPoint>& errors, float height);

/// Draws photons over the picture.
void drawPhotons(const Picture& picture, const Rectangle& where, float scale);

} // namespace vkpm
