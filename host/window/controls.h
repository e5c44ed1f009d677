/// Keys and mouse to what they mean.
#pragma once
#include "window/picture.h"
#include "window/tone.h"
#include "window/view_camera.h"
#include "window/window.h"

namespace vkpm {

/// What the user changes, by keys, mouse or the panel.
struct Choices {
    RenderRequest request{};
    SettingsOptions settings{}; // those of the request, once no slider is held
    Tone tone{};
    bool panel = true;
    bool follows = false;    // the film has the size of the window
    bool looksAbout = false; // dragging turns the head in place of orbiting
    bool copiesCamera = false;
    bool quits = false;

    bool operator==(const Choices&) const = default;
};

/// A line of the table of keys, in the panel and in host/window/README.md.
struct KeyHelp {
    const char* keys;
    const char* meaning;
};
extern const std::vector<KeyHelp> keyHelp;

/// Where the picture is, what of mouse and keys is not its own, and what is shown unless the user changes it.
struct Scenery {
    Rectangle picture{};
    double panelLeft = 0; // where the panel begins
    bool popup = false;   // a list is open over all
    bool typing = false;  // a text field has the keys
    View view{};
    float exposure = 0;

    bool isPicture(dvec2 pointer) const { return !popup && pointer.x < panelLeft; }
};

/// Follows the events of a window; keeps what is held between them.
class Controls {
public:
    /// Takes the events, and flies by the keys that are held, for so many seconds. Returns the place of the film that
    /// was double-clicked, if any.
    std::optional<dvec2> take(const std::vector<Event>& events, const Scenery& scenery, double seconds,
                              Choices& choices);
    /// Whether Shift was held at the last click.
    bool shifted() const;
    /// Whether a key that flies is held.
    bool flying() const { return !held.empty(); }

private:
    void hold(const Event& event, const Scenery& scenery);
    void key(const Event& event, const Scenery& scenery, View& view, Choices& choices) const;
    std::optional<dvec2> press(const Event& event, const Scenery& scenery);
    void drag(const Event& event, const Scenery& scenery, bool looksAbout, View& view);
    void fly(double seconds, View& view) const;

    std::optional<int> dragging; // button
    std::vector<int> held;       // keys that fly
    bool fast = false;
    int modifiers = 0;
    dvec2 pointer{0};
    double lastPress = -1;
    dvec2 lastPlace{0};
};

} // namespace vkpm
