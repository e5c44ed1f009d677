/// The loop of the window: events to requests, pictures to frames.
#pragma once
#include "output/event_log.h"
#include "window/panel.h"
#include "window/render_thread.h"
#include "window/scene_watch.h"
#include <future>

namespace vkpm {

class Viewer {
public:
    /// `start` is when the program began.
    Viewer(const RenderOptions& options, Window& window, RenderThread& thread, EventLog& log, Clock::time_point start);

    /// Until the window is closed, the program interrupted or the thread has ended.
    void run();

private:
    double patience() const;
    void takeEvents();
    void focusAt(dvec2 place);
    float sceneExposure() const;
    void updateState();
    void updateMotion();
    void updateSettings();
    void convertPicture();
    void draw();
    void logOpening();
    void logFirst();
    void endMotion();
    ivec2 room() const;
    Rectangle place() const;
    double previewsPerSecond() const;
    View viewNow() const { return choices.request.view.value_or(state.sceneView); }

    RenderOptions commandLine;
    Window& window;
    RenderThread& thread;
    EventLog& log;
    Clock::time_point start;
    SceneWatch sceneWatch;
    Controls controls;
    Choices choices;
    RenderState state;
    std::string about; // what was done last
    std::string title;

    std::shared_ptr<const Picture> picture;       // shown
    std::shared_ptr<const Picture> converted;     // newest that was given to the converter,
    Tone convertedTone;                           // and how
    std::future<std::vector<uint>> displayPixels; // of it, until they are shown
    std::jthread converter;                       // beside the window's thread, which a large film would hold up

    std::optional<View> lastView;
    Clock::time_point lastMove{};
    Clock::time_point lastFrame = Clock::now();
    Clock::time_point motionStart{};
    uint motionFrames = 0; // previews shown
    Clock::time_point lastWatch = Clock::now();
    uvec2 lastSize{0};
    Clock::time_point lastResize{};
    uint settling = 0;      // frames to draw without an event, for ImGui to come to rest
    double longestWait = 0; // seconds that an event may have waited
    bool opened = false, previewSeen = false, passSeen = false; // as the log has it
};

} // namespace vkpm
