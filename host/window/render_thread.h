/// The thread that renders for a window: it takes wishes, and gives pictures.
#pragma once
#include "job/render_job.h"
#include "window/draft.h"
#include "window/picture.h"
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace vkpm {

/// What the window wants; the thread sees to it as soon as it can.
struct Wishes {
    RenderOptions options{};    // the command line's, with the panel's values over them
    std::optional<View> view{}; // absent: the scene's
    bool moving = false;        // drafts of the view, until it rests
    bool paused = false;
    bool photons = false; // pictures come with photons
    uint reloads = 0;     // how often the scene's file has changed,
    uint saves = 0;       // and a file was asked for
    bool close = false;
    bool discard = false; // without saving
};

/// A scene with settings, and what renders it. The next one is made before this one is let go, so that what cannot be
/// rendered costs no passes.
struct Session {
    RenderOptions options;
    Scene scene; // with the view that is rendered
    Settings settings = options.settingsOf(scene.settings);
    std::string loadedText = scene.text; // as the file has them
    View loadedView = scene.view;
    std::optional<RenderJob> job{};
    std::optional<Draft> draft{};
};

class RenderThread {
public:
    /// Begins with loading the scene. `wake` is called whenever there is something new, from the thread.
    RenderThread(const RenderOptions& options, EventLog& log, std::function<void()> wake);
    ~RenderThread();

    /// Changes the wishes; a pass that they make useless is left.
    void wish(const std::function<void(Wishes&)>& change);
    const Wishes& wishes() const { return wanted; } // of the thread that wishes

    std::shared_ptr<const Picture> picture() const;
    RenderState state() const;
    /// The film's size, if it is known within so many seconds.
    std::optional<uvec2> waitForSize(double seconds);
    /// Whether it has ended, by itself only because of a failure.
    bool ended() const;

    /// Ends the pass under way, unless it is the first, and saves; false if there was no pass to save. Throws what the
    /// thread failed of.
    bool close();

private:
    void run();
    bool step();
    bool discards() const;
    Wishes take();
    bool load(const Wishes& wish);
    void adopt(std::unique_ptr<Session> next);
    void openDevice();
    void construct(Session& wanted);
    void begin();
    void beginAnew();
    void tell(const Wishes& wish);
    bool follow(const Wishes& wish);
    void startOver(const Wishes& wish);
    bool fits(uvec2 size);
    void takeView(const Wishes& wish, Session& taken);
    void drawDraft(const Wishes& wish);
    bool advance();
    bool saveIfAsked(const Wishes& wish);
    bool interruptible(bool allowed);
    void endLastPass();
    void publish();
    void estimate(const Picture& shown);
    void showPhotons(Picture& shown) const;
    void save(uint saves);
    void report(const char* activity);
    void saySo(std::string problem);
    void recover(const std::exception& error);

    // Shared, under the mutex.
    mutable std::mutex mutex;
    std::condition_variable changed;
    Wishes wanted;
    std::uint64_t version = 1;
    bool leavable = false; // the thread is in a pass
    bool sizeKnown = false;
    bool over = false;
    std::shared_ptr<const Picture> latest;
    RenderState shared;
    std::atomic<bool> cancel{false};

    // The thread's own.
    std::function<void()> wake;
    EventLog& log;
    Clock::time_point start = Clock::now();
    std::uint64_t handled = 0; // version of the wishes
    std::optional<View> view;  // wished, absent: the scene's
    uint reloaded = 0;
    uint saved = 0;
    std::optional<Gpu> gpu;
    std::unique_ptr<Session> session;
    std::optional<uvec2> refusedSize; // of a film
    bool refused = false;             // settings
    bool resumed = false;             // what the output held was taken up
    bool midPass = false;             // the job's film has part of a pass that was left
    bool failed = false;              // the problem is the device's
    bool halted = false;              // nothing to render until a wish changes
    bool hasWork = true;              // without a wish
    uint published = 0;               // passes in the latest picture
    bool withPhotons = false;
    Clock::time_point publication{};
    double publishing = 0; // seconds that the last one took
    uint nextEstimate = 2; // passes
    uint losses = 0;       // of the device
    RenderState own;
    std::exception_ptr failure;
    bool savedAtEnd = false;
    std::jthread thread;
};

} // namespace vkpm
