/// The thread that renders for a window: it takes requests, and gives pictures.
#pragma once
#include "job/render_job.h"
#include "window/preview.h"
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace vkpm {

/// A scene with settings, and what renders it. The next one is made before this one is let go, so that what cannot be
/// rendered costs no passes.
struct Session {
    RenderOptions options;
    Scene scene; // with the view that is rendered
    Settings settings = options.settingsOf(scene.settings);
    std::string loadedText = scene.text; // as the file has them
    View loadedView = scene.view;
    std::optional<View> view{}; // as requested; absent: the scene's
    std::optional<RenderJob> job{};
    std::optional<Preview> preview{};
};

class RenderThread {
public:
    /// Begins with loading the scene. `wake` is called whenever there is something new, from the thread.
    RenderThread(const RenderOptions& options, EventLog& log, std::function<void()> wake);
    ~RenderThread();

    /// Replaces the request; a pass that this makes useless is left.
    void ask(const RenderRequest& next);
    RenderState state() const;
    /// The film's size, if it is known within so many seconds.
    std::optional<uvec2> waitForSize(double seconds);
    /// Whether it has ended, by itself only because of a failure.
    bool ended() const;

    /// Ends the pass under way, unless it is the first, and saves; false if there was no pass to save. Throws what the
    /// thread failed of.
    bool close();

private:
    class Interruptible;

    void run();
    bool takeRequest(bool busy);
    bool step();
    void load();
    void adopt(std::unique_ptr<Session> next);
    bool startOver();
    void construct(Session& target);
    void begin();
    void beginAnew();
    void follow();
    std::string refusalOf(uvec2 size) const;
    void takeView(Session& target) const;
    RenderOptions options() const;
    bool showPreview();
    bool advance();
    bool saveIfAsked();
    bool publishIfDue();
    void publish();
    void update(Activity activity);
    bool recover(const std::exception& error);

    // Shared, under the mutex.
    mutable std::mutex mutex;
    std::condition_variable changed;
    RenderRequest wanted; // written by the thread that asks alone
    RenderState shared;
    bool leavable = false; // a new request may end what the device is doing
    bool over = false;
    std::atomic<bool> cancel{false};

    // The thread's own.
    RenderOptions commandLine;
    EventLog& log;
    std::function<void()> wake;
    Clock::time_point start = Clock::now();
    RenderRequest request; // that it follows now
    RenderState own;
    std::optional<Gpu> gpu;
    std::unique_ptr<Session> session;
    uint reloaded = 0;          // of the request's reloads
    uint saved = 0;             // of its saves
    bool resumed = false;       // what the output held was taken up
    bool midPass = false;       // the job's film has part of a pass that was left
    uint published = 0;         // passes in the newest picture
    bool withPhotons = false;   // this one has them
    double nextPublication = 0; // seconds since the start
    uint losses = 0;            // of the device
    std::exception_ptr failure;
    bool savedAtEnd = false;
    std::jthread thread;
};

} // namespace vkpm
