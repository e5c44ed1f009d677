/// Requests to passes and pictures: what the thread does next.
#include "window/render_thread.h"
#include "gpu/audit.h"
#include "interrupt.h"
#include "output/atomic_file.h"
#include "output/messages.h"
#include "render/radius.h"
#include "scene/camera_json.h"
#include "shared_photons.h"
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vkpm {
namespace {

const std::size_t maxPoints = 20'000; // photons shown, of each map

/// Lets the window's thread go first where there are few processors. Threads that this one starts, such as those of a
/// driver for processors, do the same.
void giveWay() { setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10); }

/// The first photons of a map are as good as any: their points are of a low-discrepancy sequence.
void addPoints(const std::optional<PhotonMapStage>& map, std::vector<PhotonPoint>& points) {
    if (!map) return;
    const std::size_t count = std::min<std::size_t>(map->tracing.arrived(), maxPoints);
    for (const Photon& photon : map->tracing.photons.download(count))
        points.push_back({photon.position, glm::abs(photon.color)});
}

} // namespace

/// While this lives a new request may end what the device is doing, unless there is one already.
class RenderThread::Interruptible {
public:
    explicit Interruptible(RenderThread& renders) : thread(renders) {
        const std::lock_guard lock(thread.mutex);
        thread.leavable = isAllowed = thread.wanted == thread.request;
    }
    ~Interruptible() {
        const std::lock_guard lock(thread.mutex);
        thread.leavable = thread.cancel = false;
    }
    bool isAllowed;

private:
    RenderThread& thread;
};

RenderThread::RenderThread(const RenderOptions& asked, EventLog& events, std::function<void()> call)
    : commandLine(asked), log(events), wake(std::move(call)) {
    wanted.settings = request.settings = asked;
    thread = std::jthread([this] { run(); });
}

RenderThread::~RenderThread() {
    RenderRequest last = wanted;
    last.close = last.discard = true;
    ask(last);
}

void RenderThread::ask(const RenderRequest& next) {
    const std::lock_guard lock(mutex);
    if (next == wanted) return;
    const bool anew = next.moving || next.discard || next.view != wanted.view || next.reloads != wanted.reloads ||
                      next.settings != wanted.settings;
    wanted = next;
    if (leavable && (anew || (next.close && shared.passes == 0))) cancel = true;
    changed.notify_all();
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
    const auto isKnown = [&] { return shared.activity != Activity::loading; };
    changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return isKnown() || over; });
    return isKnown() ? std::optional(shared.settings.size) : std::nullopt;
}

bool RenderThread::close() {
    RenderRequest last = wanted;
    last.close = true;
    ask(last);
    thread.join();
    if (failure) std::rethrow_exception(failure);
    return savedAtEnd;
}

void RenderThread::run() {
    giveWay();
    try {
        for (bool busy = true; takeRequest(busy);) busy = step();
        if (session && session->job && !request.discard) {
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

/// Takes up the request as it is now, or waits for a new one if not busy; false when all is over.
bool RenderThread::takeRequest(bool busy) {
    std::unique_lock lock(mutex);
    const auto before = Clock::now();
    changed.wait(lock, [&] { return busy || wanted != request; });
    if (session && session->job) session->job->leaveOut(secondsSince(before));
    request = wanted;
    return !request.close && !interrupted();
}

/// Does the next thing; false if there is nothing more to do for this request.
bool RenderThread::step() {
    try {
        if (!session || reloaded != request.reloads) return load(), true;
        if (!gpu) {
            gpu.emplace(commandLine.device);
            gpu->cancel = &cancel;
            gpu->timesKernels = commandLine.stats.has_value();
            requireSoundDriver(*gpu);
        }
        if (!session->preview) return showPreview(); // something to look at before the first pass
        SettingsOptions otherwise = request.settings;
        otherwise.size = session->options.size;
        if (otherwise != session->options) return startOver();
        if (request.moving) return showPreview();
        follow();
        if (!saveIfAsked()) return true;
        const RenderJob& job = *session->job;
        const bool wantsPass = !job.done() && (!request.paused || job.passCount() == 0);
        if ((midPass || wantsPass) && !advance()) return true;
        return publishIfDue();
    } catch (const Cancelled&) { // by a newer request
        return true;
    } catch (const std::exception& error) { // of the device, or of a scene or settings that load but cannot be rendered
        if (!own.picture) throw;
        return recover(error);
    }
}

/// Reads the scene. Unless it is the first, one that is broken or cannot be rendered is reported, and what there is
/// goes on.
void RenderThread::load() {
    const bool first = !session;
    try {
        auto next = std::make_unique<Session>(Session{options(), loadScene(commandLine.scene)});
        takeView(*next);
        requireFilesApart(next->options, next->scene.files);
        for (const std::string& warning : next->scene.warnings)
            warn(warning), log.write("warning", {{"text", warning}});
        if (first) {
            requireWritable(commandLine.output);
            requireWritable(pngBeside(commandLine.output));
            log.open();
        } else {
            if (gpu) construct(*next);
            log.write("reload", {{"scene", commandLine.scene.string()}});
        }
        adopt(std::move(next));
        reloaded = request.reloads;
    } catch (const Cancelled&) { // by a newer request; then it is tried again
        throw;
    } catch (const DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        if (first) throw;
        reloaded = request.reloads;
        own.problem = error.what();
        update(own.activity);
        log.write("broken scene", {{"cause", error.what()}});
    }
}

/// Goes on with another session.
void RenderThread::adopt(std::unique_ptr<Session> next) {
    session = std::move(next);
    own.problem.clear();
    own.refusal.clear();
    own.settings = session->settings;
    own.sceneView = session->loadedView;
    own.warnings = session->scene.warnings;
    midPass = false;
    if (session->job) begin();
    else update(Activity::preparing);
}

/// Other settings: all is made anew. If they cannot be rendered, what there is stays and waits for others.
bool RenderThread::startOver() {
    try {
        auto next = std::make_unique<Session>(Session{options(), session->scene});
        next->loadedText = session->loadedText;
        next->loadedView = session->loadedView;
        takeView(*next);
        construct(*next);
        adopt(std::move(next));
        return true;
    } catch (const InputError& error) {
        own.refusal = error.what();
        update(own.activity);
        saveIfAsked();
        return false;
    }
}

/// Makes the job of a session, which may be one that is not ours yet.
void RenderThread::construct(Session& target) {
    const Interruptible interruptible(*this);
    target.job.emplace(target.options, target.scene, target.settings, *gpu, log, start);
}

/// With a new job.
void RenderThread::begin() {
    RenderJob& job = *session->job;
    if (!std::exchange(resumed, true) && commandLine.resume) job.resume();
    own.leftOut = job.statistics().leftOut;
    job.begin();
    beginAnew();
}

void RenderThread::beginAnew() {
    own.settings = session->settings;
    own.errors.clear();
    midPass = false;
    published = 0;
    update(Activity::rendering);
}

/// Has a job for the request's view and size. A size that no report fits leaves the film as it is.
void RenderThread::follow() {
    const uvec2 size = request.settings.size.value_or(session->scene.settings.size);
    std::string refusal = refusalOf(size);
    if (refusal != own.refusal) {
        own.refusal = std::move(refusal);
        update(own.activity);
    }
    const bool resized = session->job && own.refusal.empty() && size != session->settings.size;
    const bool looks = request.view != session->view;
    if (resized) session->settings.size = size;
    if (looks) takeView(*session);
    if (!session->job) {
        construct(*session);
        begin();
    } else if (looks || resized) {
        session->job->restart();
        beginAnew();
    }
}

/// Why the film may not have a size; empty if it may.
std::string RenderThread::refusalOf(uvec2 size) const {
    try {
        if (session->job) session->job->requireSize(size);
        return {};
    } catch (const InputError& error) {
        return error.what();
    }
}

/// The scene's text takes the camera, so that a file says what it is a picture of.
void RenderThread::takeView(Session& target) const {
    Scene& scene = target.scene;
    target.view = request.view;
    scene.view = request.view ? inWorldDigits(*request.view) : target.loadedView;
    scene.text = scene.view == target.loadedView ? target.loadedText : withCamera(target.loadedText, scene.view);
}

/// The command line's, with the request's settings.
RenderOptions RenderThread::options() const {
    RenderOptions options = commandLine;
    static_cast<SettingsOptions&>(options) = request.settings;
    return options;
}

/// While the camera moves; false if the next preview has to wait for the next move.
bool RenderThread::showPreview() {
    std::optional<Preview>& preview = session->preview;
    const View seen = request.view.value_or(session->loadedView);
    if (preview && own.picture && own.picture->preview && own.picture->view == seen) return !request.moving;
    const auto before = Clock::now();
    if (!preview) preview.emplace(*gpu, session->scene, session->settings);
    own.picture = std::make_shared<Picture>(preview->render(seen, session->settings.size));
    published = 0;
    if (session->job) session->job->leaveOut(secondsSince(before));
    update(request.moving ? Activity::moving : Activity::preparing);
    return !request.moving;
}

/// Renders a pass, or what is left of one; false if there is a new request.
bool RenderThread::advance() {
    const Interruptible interruptible(*this);
    if (!interruptible.isAllowed) return false;
    onInterrupt("interrupted: closing the window; finished passes are saved; once more stops at once", false);
    midPass = true;
    session->job->renderPass();
    midPass = false;
    return true;
}

/// Saves the passes that there are, if it is asked for; false if there is a new request.
bool RenderThread::saveIfAsked() {
    if (saved == request.saves || !session->job || session->job->passCount() == 0) return true;
    if (midPass && !advance()) return false;
    RenderJob& job = *session->job;
    const std::string file = commandLine.output.string();
    saved = request.saves;
    try {
        job.save();
        own.saved = fmt::format("{}, {} passes", file, job.passCount());
        log.write("save", {{"file", file}, {"passes", job.passCount()}});
    } catch (const std::runtime_error& cause) {
        own.saved = cause.what();
    }
    return true;
}

/// Shows what there is, not after each pass if passes are quick; false if no pass is to follow.
bool RenderThread::publishIfDue() {
    const uint passes = session->job->passCount();
    const bool last = passes > 0 && (request.paused || session->job->done());
    const bool isNew = passes > 0 && (published != passes || withPhotons != request.photons);
    if (isNew && (last || passes == 1 || secondsSince(start) > nextPublication)) publish();
    update(!last ? Activity::rendering : request.paused ? Activity::paused : Activity::done);
    return !last;
}

void RenderThread::publish() {
    RenderJob& job = *session->job;
    const auto before = Clock::now();
    const auto shown = std::make_shared<Picture>(Picture{.pixels = job.renderer.film.download(),
                                                         .size = session->settings.size,
                                                         .view = session->scene.view,
                                                         .passes = job.passCount()});
    // Estimates come at numbers of passes that grow by a quarter at least.
    if (shown->passes >= 2 && (own.errors.empty() || 4 * shown->passes >= 5 * own.errors.back().passes))
        if (const auto error = job.estimateNow()) own.errors.push_back({job.seconds(), shown->passes, *error});
    if (request.photons) {
        addPoints(job.renderer.globalMap(), shown->photons);
        addPoints(job.renderer.causticMap(), shown->photons);
    }
    own.picture = shown;
    published = shown->passes;
    withPhotons = request.photons;
    const double seconds = secondsSince(before);
    nextPublication = secondsSince(start) + std::max(0.25, 4 * seconds);
    job.leaveOut(seconds);
}

/// Tells the window how things stand.
void RenderThread::update(Activity activity) {
    own.activity = activity;
    if (session && session->job) {
        const RenderJob& job = *session->job;
        own.passes = job.passCount();
        own.passesWanted = job.passesWanted().end == NONE ? NONE : length(job.passesWanted());
        own.seconds = job.seconds();
        own.targetError = commandLine.targetError;
        own.rays = job.rays();
        own.photons = job.photons();
        own.globalRadii = job.globalRadii();
        own.causticRadii = job.causticRadii();
        own.radiusFactor = own.passes ? radiusFactor(job.renderer.film.passes().end - 1, session->settings.alpha) : 1;
    }
    {
        const std::lock_guard lock(mutex);
        shared = own;
        changed.notify_all();
    }
    wake();
}

/// After a failure the picture stays. A lost device is opened anew, and rendering begins again; what else failed waits
/// for another request.
bool RenderThread::recover(const std::exception& error) {
    log.write("failed", {{"cause", error.what()}});
    const bool lost = dynamic_cast<const DeviceLost*>(&error) != nullptr;
    session->job.reset();
    session->preview.reset();
    midPass = false;
    if (lost) gpu.reset();
    if (lost && ++losses > 3) throw DeviceLost(error.what());
    own.refusal = error.what();
    update(lost ? Activity::preparing : Activity::stopped);
    return lost;
}

} // namespace vkpm
