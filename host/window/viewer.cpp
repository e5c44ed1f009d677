/// One turn of the loop: wait, take events, ask, draw.
#include "window/viewer.h"
#include "interrupt.h"
#include "output/film_image.h"
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
    choices.settings = choices.request.settings = options;
    lastSize = window.size();
}

void Viewer::run() {
    while (!window.closed() && !interrupted() && !thread.ended()) {
        window.wait(patience());
        const auto woken = Clock::now();
        takeEvents();
        updateState();
        updateMotion();
        updateSettings();
        thread.ask(choices.request);
        convertPicture();
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
    return choices.request.moving ? restSeconds / 3 : idleSeconds;
}

void Viewer::takeEvents() {
    const std::vector<Event> events = window.events();
    if (!events.empty()) settling = 2;
    const Scenery scenery{.picture = place(),
                          .panelLeft = choices.panel ? double(room().x) : INFINITY,
                          .popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup),
                          .typing = ImGui::GetIO().WantTextInput,
                          .view = state.sceneView,
                          .exposure = sceneExposure()};
    const auto clicked = controls.take(events, scenery, secondsSince(lastFrame), choices);
    if (!picture) choices.request.view.reset();
    if (clicked) focusAt(*clicked);
    if (std::exchange(choices.copiesCamera, false)) {
        window.copy(cameraJson(viewNow()));
        about = "the camera is copied";
    }
    if (choices.quits) window.close();
}

/// The point that is seen at a place of the film becomes the target, or with Shift what the lens sees sharply.
void Viewer::focusAt(dvec2 place) {
    const auto depth = picture ? depthAt(*picture, place) : std::nullopt;
    if (!depth) return;
    if (!controls.shifted())
        choices.request.view = focus(viewNow(), pointAt(picture->view, picture->size, place, *depth));
    else if (viewNow().lens.aperture > 0) choices.request.view = focusLens(viewNow(), *depth);
    else about = "the scene's camera has no \"aperture\"";
}

float Viewer::sceneExposure() const {
    return state.picture ? exposureOf(state.settings, state.picture->pixels) : state.settings.exposure;
}

/// The thread makes previews while the camera moves; one that was reset is at rest at once.
void Viewer::updateMotion() {
    RenderRequest& request = choices.request;
    if (request.view && request.view != lastView) lastMove = Clock::now();
    lastView = request.view;
    const bool moves = request.view && secondsSince(lastMove) < restSeconds;
    if (moves && !request.moving) {
        motionStart = Clock::now();
        motionFrames = 0;
    }
    if (request.moving && !moves) endMotion();
    request.moving = moves;
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

/// Settings count once no slider is held; a film that follows the window takes its size once this rests.
void Viewer::updateSettings() {
    RenderRequest& request = choices.request;
    if (window.size() != lastSize) {
        lastSize = window.size();
        lastResize = Clock::now();
        settling = 2;
    }
    const std::optional<uvec2> size = request.settings.size;
    if (!ImGui::IsAnyItemActive()) request.settings = choices.settings;
    request.settings.size = commandLine.size;
    if (choices.follows && room().x > 0 && room().y > 0)
        request.settings.size = secondsSince(lastResize) > settleSeconds ? uvec2(room()) : size;
    if (secondsSince(lastWatch) < watchSeconds) return;
    lastWatch = Clock::now();
    if (sceneWatch.changed()) request.reloads++;
}

void Viewer::updateState() {
    const bool isFirst = !state.picture;
    const View sceneView = std::exchange(state, thread.state()).sceneView;
    if (sceneView != state.sceneView && picture) choices.request.view.reset(); // the file has another camera now
    if (isFirst) choices.tone.exposure = sceneExposure();
}

/// Shows pixels that were converted, and has the newest picture converted unless that is under way.
void Viewer::convertPicture() {
    if (displayPixels.valid() && displayPixels.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        if (converted != picture && converted->preview) motionFrames++;
        picture = converted;
        window.setPicture(picture->size, displayPixels.get());
    }
    const bool isNew = state.picture != converted || choices.tone != convertedTone;
    if (displayPixels.valid() || !state.picture || !isNew) return;
    converted = state.picture;
    convertedTone = choices.tone;
    std::packaged_task<std::vector<uint>()> task(
        [from = converted, tone = convertedTone] { return toneMap(from->pixels, tone); });
    displayPixels = task.get_future();
    converter = std::jthread([convert = std::move(task)]() mutable {
        convert();
        Window::wake();
    });
}

/// The window's pixels beside the panel.
ivec2 Viewer::room() const { return ivec2(window.size()) - ivec2(choices.panel ? panelWidth(window.scale()) : 0, 0); }

/// The picture in the middle of the room, as large as this allows.
Rectangle Viewer::place() const {
    const dvec2 film(state.settings.size);
    if (room().x <= 0 || room().y <= 0 || film.x <= 0) return {};
    const double scale = std::min(room().x / film.x, room().y / film.y);
    const ivec2 size = glm::max(ivec2(film * scale + 0.5), ivec2(1));
    return {(room() - size) / 2, glm::min(size, room())};
}

void Viewer::draw() {
    if (settling > 0) settling--;
    lastFrame = Clock::now();
    const Rectangle where = place();
    const Choices before = choices;
    const bool drawn = window.draw(where, [&] {
        if (choices.request.photons && picture) drawPhotons(*picture, where, window.scale());
        if (choices.panel)
            drawPanel({state, commandLine, previewsPerSecond() > 0 ? picture->size : state.settings.size,
                       previewsPerSecond(), about, window.scale(), ivec2(window.size())},
                      choices);
    });
    if (!drawn) settling = std::max(settling, 1u);
    if (choices != before) settling = 2;
    logFirst();
    const std::string wanted = fmt::format("{} - vkpm: {} passes", commandLine.scene.filename().string(), state.passes);
    if (wanted != title) window.setTitle(title = wanted);
}

double Viewer::previewsPerSecond() const {
    return choices.request.moving && motionFrames > 2 ? motionFrames / secondsSince(motionStart) : 0;
}

/// What was seen first, and when.
void Viewer::logFirst() {
    if (!picture || passSeen || (previewSeen && picture->preview)) return;
    (picture->preview ? previewSeen : passSeen) = true;
    log.write(picture->preview ? "first draft" : "first pass", {{"start", secondsSince(start)}});
}

void Viewer::logOpening() {
    opened = true;
    log.write("window", {{"start", secondsSince(start)},
                         {"size", {window.size().x, window.size().y}},
                         {"panel", panelWidth(window.scale())}});
}

} // namespace vkpm
