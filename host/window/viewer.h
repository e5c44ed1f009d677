/// The loop of the window: events to wishes, pictures to frames.
#pragma once
#include "output/event_log.h"
#include "window/developer.h"
#include "window/panel.h"
#include "window/render_thread.h"
#include "window/scene_watch.h"
#include "window/window.h"

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
    void act(Action action);
    void focusAt(dvec2 place);
    void moveOrRest();
    void followWindow();
    void wishOptions();
    void watch();
    void takePicture();
    void draw();
    void logOpening();
    void logFirst();
    void endMotion();
    Rectangle place() const;
    double draftsPerSecond() const;
    View viewNow() const { return view.value_or(state.sceneView); }

    RenderOptions commandLine;
    Window& window;
    RenderThread& thread;
    EventLog& log;
    Clock::time_point start;
    SceneWatch sceneWatch;
    Controls controls;
    PanelChoices choices;
    RenderState state;
    std::shared_ptr<const Picture> picture;
    std::shared_ptr<const Picture> asked; // for a print
    std::optional<Tone> askedTone;
    Developer developer{Window::wake};
    std::optional<View> view; // absent: the scene's
    bool panel = true;
    std::string about;
    std::string title;

    bool moving = false;
    Clock::time_point lastMove{};
    Clock::time_point lastFrame = Clock::now();
    Clock::time_point motionStart{};
    uint motionFrames = 0; // drafts shown
    Clock::time_point lastWatch = Clock::now();
    uvec2 lastSize{0};
    Clock::time_point lastResize{};
    uint settling = 0;      // frames to draw without an event, for ImGui to come to rest
    double longestWait = 0; // seconds that an event may have waited
    bool opened = false, drafted = false, passSeen = false; // as the log has it
};

} // namespace vkpm
