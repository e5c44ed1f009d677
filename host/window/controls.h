/// Keys and mouse to what they mean.
#pragma once
#include "window/tone.h"
#include "window/view_camera.h"
#include "window/window.h"
#include <utility>

namespace vkpm {

/// What the user may ask for besides moving the camera.
enum class Action {
    none,
    pause,
    togglePanel,
    save,
    reset,
    copyCamera,
    togglePhotons,
    toggleFollow,
    nextCurve,
    brighter,
    darker,
    usualExposure,
    usualSettings,
    quit
};

/// A line of the table of keys, in the panel and in host/window/README.md.
struct KeyHelp {
    const char* keys;
    const char* meaning;
};
extern const std::vector<KeyHelp> keyHelp;

/// Where the picture is, and what of mouse and keys is not its own.
struct Scenery {
    Rectangle picture{};
    double panelLeft = 0; // where the panel begins
    bool popup = false;   // a list is open over all
    bool typing = false;  // a text field has the keys

    bool isPicture(dvec2 pointer) const { return !popup && pointer.x < panelLeft; }
};

/// Follows the events of a window; keeps what is held between them.
class Controls {
public:
    /// Takes the events; moves the view.
    void take(const std::vector<Event>& events, const Scenery& scenery, View& view);
    /// Flies by the keys that are held, for so many seconds.
    void fly(double seconds, View& view) const;
    /// Whether a key that flies is held.
    bool flying() const;
    /// No key is held any more: the window has lost its keys to another.
    void release();

    /// Since the last call: actions in their order, a layer that was chosen, places of the film that were
    /// double-clicked.
    std::vector<Action> actions() { return std::exchange(asked, {}); }
    std::optional<uint> layer() { return std::exchange(chosen, {}); }
    std::optional<dvec2> focus() { return std::exchange(clicked, {}); }
    bool looksAbout = false; // dragging turns the head in place of orbiting

private:
    void hold(const Event& event, const Scenery& scenery);
    void press(const Event& event, const Scenery& scenery);
    void key(const Event& event, View& view);
    void drag(const Event& event, const Scenery& scenery, View& view);

    std::optional<int> dragging; // button
    std::vector<int> held;       // keys that fly
    bool fast = false;
    int modifiers = 0;
    dvec2 pointer{0};
    double lastPress = -1;
    dvec2 lastPlace{0};
    std::vector<Action> asked;
    std::optional<uint> chosen;
    std::optional<dvec2> clicked;
};

} // namespace vkpm
