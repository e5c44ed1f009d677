/// One turn of the loop: wait, take events, wish, draw.
#include "window/viewer.h"
#include "interrupt.h"
#include "scene/camera_json.h"
#include <fmt/format.h>
#include <imgui.h>

namespace vkpm {
namespace {

const double restSeconds = 0.15;  // without a move until the camera rests
const double watchSeconds = 0.25; // between looks at the scene's files
const double settleSeconds = 0.2; // until a new size of the window counts
const double idleSeconds = 0.25;  // at most between turns

} // namespace

Viewer::Viewer(const RenderOptions& options, Window& shownIn, RenderThread& renders, EventLog& events,
               Clock::time_point begun)
    : commandLine(options), window(shownIn), thread(renders), log(events), start(begun), sceneWatch(options.scene) {
    choices.options = options;
    state = thread.state();
    choices.tone.exposure = state.settings.exposure;
    lastSize = window.size();
}

void Viewer::run() {
    while (!window.closed() && !interrupted() && !thread.ended()) {
        window.wait(patience());
        const auto woken = Clock::now();
        takeEvents();
        moveOrRest();
        followWindow();
        watch();
        takePicture();
        draw();
        longestWait = std::max(longestWait, opened ? secondsSince(woken) : 0);
        if (!opened) logOpening();
    }
    endMotion();
    log.write("window closes", {{"longestWait", longestWait}});
}

/// Seconds that the loop may sleep.
double Viewer::patience() const {
    if (settling > 0) return 0;
    if (controls.flying()) return 0.01;
    return moving ? restSeconds / 3 : idleSeconds;
}

void Viewer::takeEvents() {
    const std::vector<Event> events = window.events();
    if (!events.empty()) settling = 2;
    const ImGuiIO& io = ImGui::GetIO();
    const Scenery scenery{place(), panel ? double(window.size().x) - panelWidth(window.scale()) : INFINITY,
                          ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup), io.WantTextInput};
    const View before = viewNow();
    View after = before;
    controls.looksAbout = choices.looksAbout;
    controls.take(events, scenery, after);
    if (!window.focused()) controls.release();
    controls.fly(secondsSince(lastFrame), after);
    choices.looksAbout = controls.looksAbout;
    if (!(after == before) && picture) {
        view = after;
        lastMove = Clock::now();
    }
    if (const auto layer = controls.layer()) choices.tone.layer = *layer;
    for (const Action action : controls.actions()) act(action);
    for (const Action action : std::exchange(choices.actions, {})) act(action);
    if (const auto place = controls.focus()) focusAt(*place);
}

void Viewer::act(Action action) {
    switch (action) {
    case Action::pause:
        choices.paused = !choices.paused;
        thread.wish([&](Wishes& w) { w.paused = choices.paused; });
        break;
    case Action::togglePanel:
        panel = !panel;
        break;
    case Action::save:
        thread.wish([](Wishes& w) { w.saves++; });
        break;
    case Action::reset:
        view.reset();
        thread.wish([](Wishes& w) { w.view.reset(), w.moving = false; });
        break;
    case Action::copyCamera:
        window.copy(cameraJson(viewNow()));
        about = "the camera is copied";
        break;
    case Action::togglePhotons:
        choices.photons = !choices.photons;
        break;
    case Action::toggleFollow:
        choices.follows = !choices.follows;
        break;
    case Action::nextCurve:
        choices.tone.curve = ToneCurve((int(choices.tone.curve) + 1) % int(toneCurveNames.size()));
        break;
    case Action::brighter:
        choices.tone.exposure += 0.25f;
        break;
    case Action::darker:
        choices.tone.exposure -= 0.25f;
        break;
    case Action::usualExposure:
        choices.tone.exposure = state.settings.exposure;
        break;
    case Action::usualSettings:
        choices.options = commandLine;
        break;
    case Action::quit:
        window.close();
        break;
    case Action::none:
        break;
    }
}

/// The point that is seen at a place of the film becomes the target.
void Viewer::focusAt(dvec2 place) {
    if (!picture || glm::any(glm::lessThan(place, dvec2(0))) || glm::any(glm::greaterThanEqual(place, dvec2(1))))
        return;
    const uvec2 pixel(place * dvec2(picture->size));
    const Sample& sample = picture->pixels[std::size_t(pixel.y) * picture->size.x + pixel.x].mean;
    if (!(sample.covered > 0)) return;
    view = focus(viewNow(), pointAt(picture->view, picture->size, place, double(sample.depth) / sample.covered));
    lastMove = Clock::now();
}

/// While the camera moves the thread makes drafts.
void Viewer::moveOrRest() {
    const bool moves = secondsSince(lastMove) < restSeconds;
    const Wishes& wishes = thread.wishes();
    if (moves && !moving) {
        motionStart = Clock::now();
        motionFrames = 0;
    }
    if (moving && !moves) endMotion();
    const bool tells = moves != moving || (moves && wishes.view != view);
    moving = moves;
    if (tells) thread.wish([&](Wishes& w) { w.view = view, w.moving = moving; });
}

void Viewer::endMotion() {
    if (motionFrames < 2) return;
    const double seconds = std::chrono::duration<double>(lastMove - motionStart).count();
    if (seconds > 0)
        log.write(
            "moved",
            {{"seconds", seconds}, {"frames", motionFrames}, {"width", picture->size.x}, {"height", picture->size.y}});
    motionFrames = 0;
}

/// A film that follows the window takes its size once this rests.
void Viewer::followWindow() {
    if (window.size() != lastSize) {
        lastSize = window.size();
        lastResize = Clock::now();
        settling = 2;
    }
    RenderOptions options = choices.options;
    options.size = commandLine.size;
    const int width = int(lastSize.x) - (panel ? panelWidth(window.scale()) : 0), height = int(lastSize.y);
    if (choices.follows && width > 0 && height > 0)
        options.size = secondsSince(lastResize) > settleSeconds ? uvec2(width, height) : thread.wishes().options.size;
    const auto facts = [](const RenderOptions& o) {
        const Settings s = o.over({});
        return std::tuple(s.size, s.photons, s.causticPhotons, s.gatherRays, s.radius, s.causticRadius, s.alpha,
                          s.kernel);
    };
    const RenderOptions& wished = thread.wishes().options;
    if (facts(options) != facts(wished) || options.size.has_value() != wished.size.has_value())
        thread.wish([&](Wishes& w) { w.options = options; });
    if (choices.photons != thread.wishes().photons) thread.wish([&](Wishes& w) { w.photons = choices.photons; });
}

void Viewer::watch() {
    if (secondsSince(lastWatch) < watchSeconds) return;
    lastWatch = Clock::now();
    if (sceneWatch.changed()) thread.wish([](Wishes& w) { w.reloads++; });
}

void Viewer::takePicture() {
    const View sceneView = std::exchange(state, thread.state()).sceneView;
    if (!(sceneView == state.sceneView) && picture) act(Action::reset); // the file has another camera now
    const auto latest = thread.picture();
    if (latest && !asked) choices.tone.exposure = state.settings.exposure;
    if (latest && (latest != asked || askedTone != choices.tone)) {
        asked = latest;
        askedTone = choices.tone;
        developer.ask(asked, *askedTone);
    }
    std::optional<Print> print = developer.take();
    if (!print) return;
    if (print->picture != picture && print->picture->draft) motionFrames++;
    picture = print->picture;
    window.setPicture(picture->size, std::move(print->rgba8));
}

/// The picture beside the panel, as large as there is room, in the middle; of its own size if that is the room but for
/// a bit.
Rectangle Viewer::place() const {
    const ivec2 window_(window.size());
    const ivec2 room{window_.x - (panel ? panelWidth(window.scale()) : 0), window_.y};
    const dvec2 film(state.settings.size);
    if (room.x <= 0 || room.y <= 0 || film.x <= 0) return {};
    const double scale = std::min(room.x / film.x, room.y / film.y);
    const ivec2 size = glm::max(ivec2(film * scale + 0.5), ivec2(1));
    return {(room - size) / 2, glm::min(size, room)};
}

void Viewer::draw() {
    if (settling > 0) settling--;
    lastFrame = Clock::now();
    const Rectangle where = place();
    const Tone before = choices.tone;
    const bool drawn = window.draw(where, [&] {
        if (choices.photons && picture) drawPhotons(*picture, where, window.scale());
        if (panel)
            drawPanel({state, picture.get(), draftsPerSecond(), about, window.scale(), ivec2(window.size())}, choices);
    });
    if (!drawn) settling = std::max(settling, 1u);
    if (choices.tone != before || !choices.actions.empty()) settling = 2;
    logFirst();
    const std::string wanted = fmt::format("{} - vkpm: {} passes", commandLine.scene.filename().string(), state.passes);
    if (wanted != title) window.setTitle(title = wanted);
}

double Viewer::draftsPerSecond() const {
    return moving && motionFrames > 2 ? motionFrames / secondsSince(motionStart) : 0;
}

/// What was seen first, and when.
void Viewer::logFirst() {
    if (!picture || passSeen || (drafted && picture->draft)) return;
    (picture->draft ? drafted : passSeen) = true;
    log.write(picture->draft ? "first draft" : "first pass", {{"start", secondsSince(start)}});
}

void Viewer::logOpening() {
    opened = true;
    log.write("window", {{"start", secondsSince(start)},
                         {"size", {window.size().x, window.size().y}},
                         {"panel", panelWidth(window.scale())}});
}

} // namespace vkpm
