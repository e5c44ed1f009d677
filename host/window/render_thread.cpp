/// Wishes to passes: what the thread does next.
#include "window/render_thread.h"
#include "gpu/audit.h"
#include "output/atomic_file.h"
#include "output/interrupt.h"
#include "scene/settings_json.h"
#include "window/camera_json.h"
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vkpm {

/// Lets the window's thread go first where there are few processors. Threads that this one starts, such as those of a driver for
/// processors, do the same.
static void giveWay() {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
}

RenderThread::RenderThread(const Options& asked, EventLog& events, std::function<void()> call) : wake(std::move(call)), log(events) {
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
    const bool anew = wanted.moving || wanted.discard || wanted.view != before.view || wanted.reloads != before.reloads ||
                      settingsJson(wanted.options.override({})) != settingsJson(before.options.override({}));
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
        if (job && !broken && !discards()) savedAtEnd = job->finish();
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
    if (job) job->leaveOut(secondsSince(before));
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
        if (!draft) return drawDraft(wish), true; // something to look at before the first pass
        if (!follow(wish)) return true;
        if (saved != wish.saves && job->passCount() > 0) save(wish.saves);
        if (!job->done() && (!wish.paused || job->passCount() == 0)) advance();
        tell(wish);
    } catch (const Cancelled&) {
        broken = true;
        hasWork = true;
        endLastPass();
    } catch (const GpuError& error) {
        if (!latest) throw;
        recover(error);
    }
    return true;
}

/// Shows what there is, not after each pass if passes are quick.
void RenderThread::tell(const Wishes& wish) {
    const uint passes = job->passCount();
    const bool last = passes > 0 && (wish.paused || job->done());
    const bool due = published != passes || withPhotons != wish.photons;
    withPhotons = wish.photons;
    if (passes > 0 && due && (last || passes == 1 || secondsSince(publication) > std::max(0.25, 4 * publishing))) publish();
    report(!last ? "rendering" : wish.paused ? "paused" : "done");
    hasWork = !last;
}

/// Has a scene, if need be the newest that its file has; false if it is broken, and was told so.
bool RenderThread::load(const Wishes& wish) {
    if (scene && reloaded == wish.reloads) return true;
    const bool first = !scene;
    reloaded = wish.reloads;
    try {
        Scene next = loadScene(wish.options.scene);
        for (const std::string& warning : next.warnings) fmt::print(stderr, "vkpm: warning: {}\n", warning);
        options = wish.options;
        settings = options.override(next.settings);
        loadedText = next.text;
        loadedView = next.view;
        scene = std::move(next);
        own.problem.clear();
    } catch (const InputError& error) {
        if (first) throw;
        saySo(error.what());
        log.write("broken scene", {{"cause", error.what()}});
        return false;
    }
    if (first) requireWritable(options.output), requireWritable(pngBeside(options.output));
    else log.write("reload", {{"scene", options.scene.string()}});
    job.reset();
    draft.reset();
    own.settings = settings;
    own.sceneView = loadedView;
    report("preparing");
    const std::lock_guard lock(mutex);
    sizeKnown = true;
    changed.notify_all();
    return true;
}

void RenderThread::openDevice() {
    gpu.emplace(options.device);
    gpu->cancel = &cancel;
    gpu->timesKernels = options.stats.has_value();
    requireSoundDriver(*gpu);
    own.device = gpu->info().name;
}

void RenderThread::construct() {
    interruptible(true);
    job.emplace(options, *scene, settings, *gpu, log, start);
    endLastPass();
    if (options.resume && !latest) job->resume();
    own.leftOut = job->statistics().leftOut;
    if (std::exchange(failed, false)) own.problem.clear();
    job->begin();
    beginAnew();
}

void RenderThread::beginAnew() {
    own.settings = settings;
    own.errors.clear();
    broken = false;
    published = 0;
    nextEstimate = 2;
    report("rendering");
}

/// Has a job for the wishes; false if there was something else to do.
bool RenderThread::follow(const Wishes& wish) {
    const Settings next = wish.options.override(scene->settings);
    const bool sameButSize = [&] {
        Settings resized = next;
        resized.size = settings.size;
        return settingsJson(resized) == settingsJson(settings);
    }();
    const bool resized = next.size != settings.size;
    const bool looks = wish.view != view;
    if (!sameButSize) return startOver(wish), false;
    if (wish.moving) return drawDraft(wish), false;

    options = wish.options;
    settings = next;
    if (looks || !job) takeView(wish);
    if (!job) construct();
    else if (looks || resized || broken) {
        job->restart();
        beginAnew();
    }
    return true;
}

/// Other settings: all is made anew.
void RenderThread::startOver(const Wishes& wish) {
    job.reset();
    draft.reset();
    options = wish.options;
    settings = options.override(scene->settings);
    hasWork = true;
}

/// The scene's text takes the camera, so that a file says what it is a picture of.
void RenderThread::takeView(const Wishes& wish) {
    view = wish.view;
    scene->view = view ? inWorldDigits(*view) : loadedView;
    scene->text = scene->view == loadedView ? loadedText : withCamera(loadedText, scene->view);
}

void RenderThread::drawDraft(const Wishes& wish) {
    const View seen = wish.view.value_or(loadedView);
    hasWork = !wish.moving;
    if (draft && latest && latest->draft && latest->view == seen) return;
    const auto before = Clock::now();
    if (!draft) draft.emplace(*gpu, *scene, settings);
    const auto shown = std::make_shared<Picture>(draft->render(seen, settings.size));
    {
        const std::lock_guard lock(mutex);
        latest = shown;
    }
    published = 0;
    if (job) job->leaveOut(secondsSince(before));
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

void RenderThread::advance() {
    if (!interruptible(true)) return;
    job->renderPass();
    endLastPass();
}

} // namespace vkpm
