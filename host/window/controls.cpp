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

/// Arrows orbit, or pan with shift; plus and minus dolly.
bool moveByKey(const Event& event, View& view) {
    const int key = event.code;
    if (event.modifiers & GLFW_MOD_CONTROL) return false;
    const dvec2 step{(key == GLFW_KEY_RIGHT) - (key == GLFW_KEY_LEFT), (key == GLFW_KEY_UP) - (key == GLFW_KEY_DOWN)};
    if (step != dvec2(0))
        view = event.modifiers & GLFW_MOD_SHIFT ? pan(view, 0.05 * step) : orbit(view, -keyAngle * step);
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
    {"Shift + double click", "the lens is focused there"},
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

/// Keys that act once: pressed, not repeated or let go.
void Controls::key(const Event& event, const Scenery& scenery, View& view, Choices& choices) const {
    const int code = event.code;
    RenderRequest& request = choices.request;
    if (event.modifiers & GLFW_MOD_CONTROL) {
        if (code == GLFW_KEY_S) request.saves++;
        if (code == GLFW_KEY_C) choices.copiesCamera = true;
        if (code == GLFW_KEY_Q) choices.quits = true;
        return;
    }
    if (code == GLFW_KEY_SPACE) request.paused = !request.paused;
    if (code == GLFW_KEY_P) request.photons = !request.photons;
    if (code == GLFW_KEY_HOME || code == GLFW_KEY_R) view = scenery.view;
    if (code == GLFW_KEY_TAB) choices.panel = !choices.panel;
    if (code == GLFW_KEY_G) choices.follows = !choices.follows;
    if (code == GLFW_KEY_F) choices.looksAbout = !choices.looksAbout;
    if (code == GLFW_KEY_C) choices.copiesCamera = true;
    if (code == GLFW_KEY_T) choices.tone.curve = ToneCurve((int(choices.tone.curve) + 1) % int(toneCurveNames.size()));
    if (code == GLFW_KEY_X) choices.tone.exposure += event.modifiers & GLFW_MOD_SHIFT ? -0.25f : 0.25f;
    if (code == GLFW_KEY_Z) choices.tone.exposure = scenery.exposure;
    if (code >= GLFW_KEY_0 && code <= GLFW_KEY_9)
        choices.tone.layer = code == GLFW_KEY_0 ? 9u : uint(code - GLFW_KEY_1);
    for (const FlyKey& fly : flyKeys)
        if (code == fly.key) view = vkpm::fly(view, fly.direction * flySpeed * nudge);
}

/// Begins or ends a drag. Returns the place of the film if it is the second click of a double click.
std::optional<dvec2> Controls::press(const Event& event, const Scenery& scenery) {
    if (event.action == GLFW_RELEASE) {
        if (dragging == event.code) dragging.reset();
        return {};
    }
    if (!scenery.isPicture(event.position)) return {};
    if (!dragging) dragging = event.code;
    modifiers = event.modifiers;
    pointer = event.position;
    if (event.code != GLFW_MOUSE_BUTTON_LEFT) return {};
    const bool twice = glfwGetTime() - lastPress < doubleClick && glm::distance(lastPlace, event.position) < still;
    lastPress = twice ? -1 : glfwGetTime();
    lastPlace = event.position;
    if (!twice || scenery.picture.size.x <= 0) return {};
    return (event.position - dvec2(scenery.picture.corner)) / dvec2(scenery.picture.size);
}

/// Shift pans and Ctrl dollies with any button, as in Blender; the right button pans, as in viewers of glTF.
void Controls::drag(const Event& event, const Scenery& scenery, bool looksAbout, View& view) {
    const dvec2 moved = (event.position - pointer) / double(std::max(scenery.picture.size.y, 1));
    pointer = event.position;
    if (!dragging || moved == dvec2(0)) return;
    if (modifiers & GLFW_MOD_CONTROL) view = dolly(view, std::exp(2 * moved.y));
    else if ((modifiers & GLFW_MOD_SHIFT) || dragging == GLFW_MOUSE_BUTTON_RIGHT) view = pan(view, {-moved.x, moved.y});
    else if (looksAbout) view = turn(view, orbitPerHeight / 2 * dvec2(moved.x, -moved.y));
    else view = orbit(view, orbitPerHeight * dvec2(moved.x, -moved.y));
}

/// Keys that fly, until they are let go; those that are part of a shortcut do not. A window that loses the keys to
/// another lets all go.
void Controls::hold(const Event& event, const Scenery& scenery) {
    fast = event.modifiers & GLFW_MOD_SHIFT;
    for (const FlyKey& fly : flyKeys) {
        if (event.code != fly.key || event.action == GLFW_REPEAT) continue;
        const bool begins = event.action == GLFW_PRESS && !(event.modifiers & GLFW_MOD_CONTROL) && !scenery.typing;
        std::erase(held, event.code);
        if (begins) held.push_back(event.code);
    }
}

bool Controls::shifted() const { return modifiers & GLFW_MOD_SHIFT; }

void Controls::fly(double seconds, View& view) const {
    dvec3 direction{0};
    for (const FlyKey& fly : flyKeys)
        if (std::ranges::find(held, fly.key) != held.end()) direction += fly.direction;
    if (direction != dvec3(0)) view = vkpm::fly(view, direction * ((fast ? 4 : 1) * flySpeed * std::min(seconds, 0.1)));
}

std::optional<dvec2> Controls::take(const std::vector<Event>& events, const Scenery& scenery, double seconds,
                                    Choices& choices) {
    std::optional<dvec2> clicked;
    std::optional<View>& asked = choices.request.view;
    const View before = asked.value_or(scenery.view);
    View view = before;
    for (const Event& event : events) {
        switch (event.kind) {
        case Event::Kind::key:
            hold(event, scenery);
            if (scenery.typing || event.action == GLFW_RELEASE || moveByKey(event, view)) break;
            if (event.action == GLFW_PRESS) key(event, scenery, view, choices);
            break;
        case Event::Kind::button:
            if (const auto place = press(event, scenery)) clicked = place;
            break;
        case Event::Kind::move:
            drag(event, scenery, choices.looksAbout, view);
            break;
        case Event::Kind::scroll:
            if (scenery.isPicture(event.position)) view = dolly(view, std::pow(dollyPerStep, event.scroll));
            break;
        }
    }
    fly(seconds, view);
    if (view != before) asked = view == scenery.view ? std::nullopt : std::optional(view);
    return clicked;
}

} // namespace vkpm
