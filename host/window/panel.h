/// The panel beside the picture: how the render stands, and what may be changed.
#pragma once
#include "window/controls.h"

namespace vkpm {

/// What the panel shows.
struct PanelInput {
    const RenderState& state;
    const SettingsOptions& usual; // settings to go back to
    uvec2 film;                   // size of what is shown
    double previewsPerSecond;     // while the camera moves
    const std::string& about;     // what was done last
    float scale;
    ivec2 window;
};

/// Its width in the window's pixels.
int panelWidth(float scale);

/// Draws it with ImGui at the right edge of the window.
void drawPanel(const PanelInput& input, Choices& choices);

/// Draws the estimated error over seconds, both logarithmic, into what is left of the panel's width.
void drawErrorCurve(const std::vector<ErrorPoint>& errors, float height);

/// Draws photons over the picture.
void drawPhotons(const Picture& picture, const Rectangle& where, float scale);

} // namespace vkpm
