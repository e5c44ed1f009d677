/// Wishes to passes: what the thread does next.
#include "window/render_thread.h"
#include "gpu/audit.h"
#include "interrupt.h"
#include "output/atomic_file.h"
#include "output/messages.h"
#include "scene/camera_json.h"
#include "scene/settings_json.h"
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vkpm {

/// Lets the window's thread go first where there are few processors. Threads that this one starts, such as those of a
/// driver for processors, do the same.
static void giveWay() { setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10); }

RenderThread::RenderThread(const RenderOptions& asked, EventLog& events, std::function<void()> call)
    : wake(std::move(call)), log(events) {
    wanted.options = asked;
    thread = std::jthread([this] { run(); });
}

RenderThread::~RenderThread() {
    wish([](Wishes& w) { w.close = w.discard = true; });
}

void RenderThread::wish(const std::function<void(Wishes&)>& change) {
    const std::lock_guard lock(mutex);
    const Wishes before = wanted;
    change(wanted);
    version++;
    const bool anew = wanted.moving || wanted.discard || wanted.view != before.view ||
                      wanted.reloads != before.reloads ||
                      settingsJson(wanted.options.over({})) != settingsJson(before.options.over({}));
    if (leavable && (anew || (wanted.close && shared.passes == 0))) cancel = true;
    changed.notify_all();
}

std::shared_ptr<const Picture> RenderThread::picture() const {
    const std::lock_guard lock(mutex);
    return latest;
}

RenderState RenderThread::state() const {
    const std::lock_guard lock(mutex);
    return shared;
}

bool RenderThread::ended() const {
    const std::lock_guard lock(mutex);
    return over;
}

std::optional<uvec2> RenderThread::waitForSize(double seconds) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return sizeKnown || over; });
    return sizeKnown ? std::optional(shared.settings.size) : std::nullopt;
}

bool RenderThread::close() {
    wish([](Wishes& w) { w.close = true; });
    thread.join();
    if (failure) std::rethrow_exception(failure);
    return savedAtEnd;
}

void RenderThread::run() {
    giveWay();
    try {
        while (step()) continue;
        if (session && session->job && !discards()) {
            RenderJob& job = *session->job;
            if (midPass && job.passCount() > 0) job.renderPass();
            savedAtEnd = job.finish();
        }
    } catch (...) {
        failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    over = true;
    changed.notify_all();
    wake();
}

bool RenderThread::discards() const {
    const std::lock_guard lock(mutex);
    return wanted.discard;
}

/// The wishes as they are now, once there is anything to do.
Wishes RenderThread::take() {
    std::unique_lock lock(mutex);
    const auto before = Clock::now();
    changed.wait(lock, [&] { return hasWork || version != handled; });
    if (session && session->job) session->job->leaveOut(secondsSince(before));
    if (version != handled) halted = false;
    handled = version;
    return wanted;
}

/// Does the next thing; false when all is over.
bool RenderThread::step() {
    const Wishes wish = take();
    if (wish.close || interrupted()) return false;
    try {
        if (!load(wish)) return true;
        if (halted) return hasWork = false, true;
        if (!gpu) openDevice();
        if (!session->draft) return drawDraft(wish), true; // something to look at before the first pass
        if (!follow(wish)) return true;
        const RenderJob& job = *session->job;
        if (!saveIfAsked(wish)) return true;
        if ((midPass || (!job.done() && (!wish.paused || job.passCount() == 0))) && !advance()) return true;
        tell(wish);
    } catch (const Cancelled&) {
        midPass = true;
        hasWork = true;
        endLastPass();
    } catch (const std::exception& error) { // of the device, or of a scene or settings that load but cannot be rendered
        if (!latest) throw;
        recover(error);
    }
    return true;
}

/// Shows what there is, not after each pass if passes are quick.
void RenderThread::tell(const Wishes& wish) {
    const uint passes = session->job->passCount();
    const bool last = passes > 0 && (wish.paused || session->job->done());
    const bool due = published != passes || withPhotons != wish.photons;
    withPhotons = wish.photons;
    if (passes > 0 && due && (last || passes == 1 || secondsSince(publication) > std::max(0.25, 4 * publishing)))
        publish();
    report(!last ? "rendering" : wish.paused ? "paused" : "done");
    hasWork = !last;
}

/// Has a scene, if need be the newest that its file has; false if it is broken or cannot be rendered, and was told so,
/// or was taken up just now.
bool RenderThread::load(const Wishes& wish) {
    if (session && reloaded == wish.reloads) return true;
    const bool first = !session;
    try {
        auto next = std::make_unique<Session>(Session{wish.options, loadScene(wish.options.scene)});
        requireFilesApart(next->options, next->scene.files);
        for (const std::string& warning : next->scene.warnings)
            warn(warning), log.write("warning", {{"text", warning}});
        if (first) {
            requireWritable(next->options.output);
            requireWritable(pngBeside(next->options.output));
            log.open();
        } else {
            if (gpu) construct(*next);
            log.write("reload", {{"scene", next->options.scene.string()}});
        }
        adopt(std::move(next));
        reloaded = wish.reloads;
        return first;
    } catch (const Cancelled&) { // by a newer wish; then it is tried again
        endLastPass();
        hasWork = true;
        return false;
    } catch (const DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        if (first) throw;
        reloaded = wish.reloads;
        endLastPass();
        saySo(error.what());
        log.write("broken scene", {{"cause", error.what()}});
        return false;
    }
}

/// Goes on with another session.
void RenderThread::adopt(std::unique_ptr<Session> next) {
    session = std::move(next);
    own.problem.clear();
    own.settings = session->settings;
    own.sceneView = session->loadedView;
    own.warnings = session->scene.warnings;
    hasWork = true;
    halted = false;
    midPass = false;
    if (session->job) begin();
    else report("preparing");
    const std::lock_guard lock(mutex);
    sizeKnown = true;
    changed.notify_all();
}

void RenderThread::openDevice() {
    const RenderOptions& options = session->options;
    gpu.emplace(options.device);
    gpu->cancel = &cancel;
    gpu->timesKernels = options.stats.has_value();
    requireSoundDriver(*gpu);
    own.device = gpu->info().name;
}

/// Makes the job of a session, which may be one that is not ours yet.
void RenderThread::construct(Session& wanted) {
    interruptible(true);
    wanted.job.emplace(wanted.options, wanted.scene, wanted.settings, *gpu, log, start);
    endLastPass();
}

/// With a new job.
void RenderThread::begin() {
    RenderJob& job = *session->job;
    if (session->options.resume && !resumed) job.resume();
    resumed = true;
    own.leftOut = job.statistics().leftOut;
    if (std::exchange(failed, false)) own.problem.clear();
    job.begin();
    beginAnew();
}

void RenderThread::beginAnew() {
    own.settings = session->settings;
    own.errors.clear();
    midPass = false;
    published = 0;
    nextEstimate = 2;
    report("rendering");
}

/// Has a job for the wishes; false if there was something else to do.
bool RenderThread::follow(const Wishes& wish) {
    Settings& settings = session->settings;
    const Settings next = wish.options.settingsOf(session->scene.settings);
    const bool sameButSize = [&] {
        Settings resized = next;
        resized.size = settings.size;
        return settingsJson(resized) == settingsJson(settings);
    }();
    if (!sameButSize) return startOver(wish), false;
    if (std::exchange(refused, false)) own.problem.clear();
    if (wish.moving) return drawDraft(wish), false;

    const bool resized = next.size != settings.size && fits(next.size);
    const bool looks = wish.view != view;
    session->options = wish.options;
    if (resized) settings.size = next.size;
    if (looks || !session->job) takeView(wish, *session);
    if (!session->job) {
        construct(*session);
        begin();
    } else if (looks || resized) {
        session->job->restart();
        beginAnew();
    }
    return true;
}

/// Whether the film may have a size; says why not.
bool RenderThread::fits(uvec2 size) {
    if (!session->job || refusedSize == size) return refusedSize != size;
    try {
        session->job->requireSize(size);
    } catch (const InputError& error) {
        refusedSize = size;
        saySo(error.what());
        return false;
    }
    if (std::exchange(refusedSize, std::nullopt)) own.problem.clear();
    return true;
}

/// Other settings: all is made anew. If they cannot be rendered, what there is stays and waits for others.
void RenderThread::startOver(const Wishes& wish) {
    Scene scene = session->scene;
    scene.text = session->loadedText;
    scene.view = session->loadedView;
    auto next = std::make_unique<Session>(Session{wish.options, std::move(scene)});
    const std::optional<View> before = view;
    takeView(wish, *next);
    try {
        construct(*next);
        return adopt(std::move(next));
    } catch (const Cancelled&) { // by a newer wish
        hasWork = true;
    } catch (const InputError& error) {
        halted = refused = true;
        hasWork = false;
        saySo(error.what());
    }
    view = before;
    endLastPass();
    if (halted) saveIfAsked(wish);
}

/// The scene's text takes the camera, so that a file says what it is a picture of.
void RenderThread::takeView(const Wishes& wish, Session& taken) {
    Scene& scene = taken.scene;
    view = wish.view;
    scene.view = view ? inWorldDigits(*view) : taken.loadedView;
    scene.text = scene.view == taken.loadedView ? taken.loadedText : withCamera(taken.loadedText, scene.view);
}

void RenderThread::drawDraft(const Wishes& wish) {
    std::optional<Draft>& draft = session->draft;
    const View seen = wish.view.value_or(session->loadedView);
    hasWork = !wish.moving;
    if (draft && latest && latest->draft && latest->view == seen) return;
    const auto before = Clock::now();
    if (!draft) draft.emplace(*gpu, session->scene, session->settings);
    const auto shown = std::make_shared<Picture>(draft->render(seen, session->settings.size));
    {
        const std::lock_guard lock(mutex);
        latest = shown;
    }
    published = 0;
    if (session->job) session->job->leaveOut(secondsSince(before));
    report(wish.moving ? "moving" : "preparing");
}

/// From now on a wish may end what the device is doing, unless there is a new one already: then false.
bool RenderThread::interruptible(bool allowed) {
    const std::lock_guard lock(mutex);
    leavable = allowed && version == handled;
    return leavable;
}

void RenderThread::endLastPass() {
    const std::lock_guard lock(mutex);
    leavable = false;
    cancel = false;
}

/// Renders a pass, or what is left of one; false if there is a new wish.
bool RenderThread::advance() {
    if (!interruptible(true)) return false;
    onInterrupt("interrupted: closing the window; finished passes are saved; once more stops at once", false);
    session->job->renderPass();
    midPass = false;
    endLastPass();
    return true;
}

/// Saves the passes that there are, if it is wished; false if there is a new wish.
bool RenderThread::saveIfAsked(const Wishes& wish) {
    if (saved == wish.saves || session->job->passCount() == 0) return true;
    if (midPass && !advance()) return false;
    save(wish.saves);
    return true;
}

} // namespace vkpm
