/// The table of keys, and drags.
#include "window/controls.h"
#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace vkpm {
namespace {

const double orbitPerHeight = glm::pi<double>(); // radians, for a drag over the height of the picture
const double dollyPerStep = 0.85;                // of the distance, for a step of the wheel
const double keyAngle = glm::radians(5.0);
const double flySpeed = 0.8;     // distances to the target in a second
const double nudge = 1.0 / 30;   // seconds that the shortest press flies
const double doubleClick = 0.35; // seconds
const double still = 6;          // pixels that a double click may move

struct FlyKey {
    int key;
    dvec3 direction;
};
const FlyKey flyKeys[]{{GLFW_KEY_W, {0, 0, 1}}, {GLFW_KEY_S, {0, 0, -1}}, {GLFW_KEY_A, {-1, 0, 0}},
                       {GLFW_KEY_D, {1, 0, 0}}, {GLFW_KEY_E, {0, 1, 0}},  {GLFW_KEY_Q, {0, -1, 0}}};

Action actionOf(int key, bool control, bool shift) {
    if (control)
        return key == GLFW_KEY_S   ? Action::save
               : key == GLFW_KEY_C ? Action::copyCamera
               : key == GLFW_KEY_Q ? Action::quit
                                   : Action::none;
    switch (key) {
    case GLFW_KEY_SPACE:
        return Action::pause;
    case GLFW_KEY_TAB:
        return Action::togglePanel;
    case GLFW_KEY_HOME:
    case GLFW_KEY_R:
        return Action::reset;
    case GLFW_KEY_C:
        return Action::copyCamera;
    case GLFW_KEY_P:
        return Action::togglePhotons;
    case GLFW_KEY_G:
        return Action::toggleFollow;
    case GLFW_KEY_T:
        return Action::nextCurve;
    case GLFW_KEY_X:
        return shift ? Action::darker : Action::brighter;
    case GLFW_KEY_Z:
        return Action::usualExposure;
    default:
        return Action::none;
    }
}

/// Arrows orbit, or pan with shift; plus and minus dolly.
bool moveByKey(int key, bool shift, View& view) {
    const dvec2 step{(key == GLFW_KEY_RIGHT) - (key == GLFW_KEY_LEFT), (key == GLFW_KEY_UP) - (key == GLFW_KEY_DOWN)};
    if (step != dvec2(0)) view = shift ? pan(view, 0.05 * step) : orbit(view, -keyAngle * step);
    const bool nearer = key == GLFW_KEY_EQUAL || key == GLFW_KEY_KP_ADD,
               farther = key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT;
    if (nearer || farther) view = dolly(view, nearer ? dollyPerStep : 1 / dollyPerStep);
    return step != dvec2(0) || nearer || farther;
}

} // namespace

const std::vector<KeyHelp> keyHelp{
    {"1 ... 0", "beauty, emission, direct, specular, caustic, indirect, albedo, normal, noise, bias"},
    {"drag", "orbit (left or middle button)"},
    {"Shift + drag, right button", "pan"},
    {"wheel, Ctrl + drag, + -", "dolly"},
    {"double click", "focus: orbit around this point"},
    {"W A S D, E Q", "fly; with Shift faster"},
    {"F", "drags look about, or orbit again"},
    {"arrows", "orbit; with Shift pan"},
    {"Home, R", "the scene's camera again"},
    {"C", "copy the camera as JSON"},
    {"X, Shift + X, Z", "exposure up, down, the scene's"},
    {"T", "next tone curve"},
    {"P", "photons as points"},
    {"G", "the film follows the window"},
    {"Space", "pause, go on"},
    {"Ctrl + S", "save EXR and PNG"},
    {"Tab", "hide or show the panel"},
    {"Ctrl + Q", "close and save"}};

void Controls::key(const Event& event, View& view) {
    const bool control = event.modifiers & GLFW_MOD_CONTROL, shift = event.modifiers & GLFW_MOD_SHIFT;
    if (event.action == GLFW_RELEASE || (!control && moveByKey(event.code, shift, view)) || event.action != GLFW_PRESS)
        return;
    if (const Action action = actionOf(event.code, control, shift); action != Action::none) asked.push_back(action);
    if (control) return;
    if (event.code >= GLFW_KEY_0 && event.code <= GLFW_KEY_9)
        chosen = event.code == GLFW_KEY_0 ? 9u : uint(event.code - GLFW_KEY_1);
    if (event.code == GLFW_KEY_F) looksAbout = !looksAbout;
    for (const FlyKey& fly : flyKeys)
        if (event.code == fly.key) view = vkpm::fly(view, fly.direction * flySpeed * nudge);
}

void Controls::press(const Event& event, const Scenery& scenery) {
    if (event.action == GLFW_RELEASE) {
        if (dragging == event.code) dragging.reset();
        return;
    }
    if (!scenery.isPicture(event.position)) return;
    if (!dragging) dragging = event.code;
    modifiers = event.modifiers;
    pointer = event.position;
    if (event.code != GLFW_MOUSE_BUTTON_LEFT) return;
    const bool twice = glfwGetTime() - lastPress < doubleClick && glm::distance(lastPlace, event.position) < still;
    lastPress = twice ? -1 : glfwGetTime();
    lastPlace = event.position;
    if (twice && scenery.picture.size.x > 0)
        clicked = (event.position - dvec2(scenery.picture.corner)) / dvec2(scenery.picture.size);
}

/// Shift pans and Ctrl dollies with any button, as in Blender; the right button pans, as in viewers of glTF.
void Controls::drag(const Event& event, const Scenery& scenery, View& view) {
    const dvec2 moved = (event.position - pointer) / double(std::max(scenery.picture.size.y, 1));
    pointer = event.position;
    if (!dragging || moved == dvec2(0)) return;
    if (modifiers & GLFW_MOD_CONTROL) view = dolly(view, std::exp(2 * moved.y));
    else if ((modifiers & GLFW_MOD_SHIFT) || dragging == GLFW_MOUSE_BUTTON_RIGHT) view = pan(view, {-moved.x, moved.y});
    else if (looksAbout) view = turn(view, orbitPerHeight / 2 * dvec2(moved.x, -moved.y));
    else view = orbit(view, orbitPerHeight * dvec2(moved.x, -moved.y));
}

void Controls::take(const std::vector<Event>& events, const Scenery& scenery, View& view) {
    for (const Event& event : events) {
        switch (event.kind) {
        case Event::Kind::key:
            hold(event, scenery);
            if (!scenery.typing) key(event, view);
            break;
        case Event::Kind::button:
            press(event, scenery);
            break;
        case Event::Kind::move:
            drag(event, scenery, view);
            break;
        case Event::Kind::scroll:
            if (scenery.isPicture(event.position)) view = dolly(view, std::pow(dollyPerStep, event.scroll));
            break;
        }
    }
}

/// Keys that fly, until they are let go; those that are part of a shortcut do not.
void Controls::hold(const Event& event, const Scenery& scenery) {
    fast = event.modifiers & GLFW_MOD_SHIFT;
    for (const FlyKey& fly : flyKeys) {
        if (event.code != fly.key || event.action == GLFW_REPEAT) continue;
        const bool begins = event.action == GLFW_PRESS && !(event.modifiers & GLFW_MOD_CONTROL) && !scenery.typing;
        std::erase(held, event.code);
        if (begins) held.push_back(event.code);
    }
}

bool Controls::flying() const { return !held.empty(); }

void Controls::release() { held.clear(); }

void Controls::fly(double seconds, View& view) const {
    dvec3 direction{0};
    for (const FlyKey& fly : flyKeys)
        if (std::ranges::find(held, fly.key) != held.end()) direction += fly.direction;
    if (direction != dvec3(0)) view = vkpm::fly(view, direction * ((fast ? 4 : 1) * flySpeed * std::min(seconds, 0.1)));
}

} // namespace vkpm
