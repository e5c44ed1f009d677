/// What the thread has to tell: pictures, numbers, files, failures.
#include "render/radius.h"
#include "shared_photons.h"
#include "window/render_thread.h"
#include <fmt/format.h>

namespace vkpm {
namespace {

const std::size_t maxPoints = 20'000; // photons shown, of each map

void addPoints(const std::optional<PhotonMapStage>& map, std::vector<PhotonPoint>& points) {
    if (!map) return;
    const std::size_t count = std::min<std::size_t>(map->tracing.arrived(), maxPoints);
    for (const Photon& photon : map->tracing.photons.download(count)) points.push_back({photon.position, photon.color});
}

} // namespace

void RenderThread::publish() {
    const RenderJob& job = *session->job;
    const auto before = Clock::now();
    const auto shown = std::make_shared<Picture>(Picture{.pixels = job.renderer.film.download(),
                                                         .size = session->settings.size,
                                                         .view = session->scene.view,
                                                         .passes = job.passCount()});
    if (shown->passes >= nextEstimate) estimate(*shown);
    if (withPhotons) showPhotons(*shown);
    published = shown->passes;
    {
        const std::lock_guard lock(mutex);
        latest = shown;
    }
    publication = Clock::now();
    publishing = secondsSince(before);
    session->job->leaveOut(publishing);
}

/// At numbers of passes that grow by a quarter at least.
void RenderThread::estimate(const Picture& shown) {
    const RenderJob& job = *session->job;
    if (const auto error = job.estimateNow()) own.errors.push_back({job.seconds(), shown.passes, *error});
    nextEstimate = shown.passes + (shown.passes + 3) / 4;
}

/// The first photons of a map are as good as any: their points are of a low-discrepancy sequence.
void RenderThread::showPhotons(Picture& shown) const {
    addPoints(session->job->renderer.globalMap(), shown.photons);
    addPoints(session->job->renderer.causticMap(), shown.photons);
}

void RenderThread::save(uint saves) {
    RenderJob& job = *session->job;
    const std::string file = session->options.output.string();
    saved = saves;
    try {
        job.save();
        own.saved = fmt::format("{}, {} passes", file, job.passCount());
        own.saves++;
        log.write("save", {{"file", file}, {"passes", job.passCount()}});
    } catch (const std::runtime_error& cause) {
        own.saved = cause.what();
    }
}

void RenderThread::report(const char* activity) {
    own.activity = activity;
    if (session && session->job) {
        const RenderJob* job = &*session->job;
        own.passes = job->passCount();
        own.passesWanted = job->passesWanted().end == NONE ? NONE : length(job->passesWanted());
        own.seconds = job->seconds();
        own.rays = job->rays();
        own.photons = job->photons();
        own.globalRadii = job->globalRadii();
        own.causticRadii = job->causticRadii();
        own.radiusFactor = own.passes ? radiusFactor(job->renderer.film.passes().end - 1, session->settings.alpha) : 1;
    }
    {
        const std::lock_guard lock(mutex);
        shared = own;
    }
    wake();
}

void RenderThread::saySo(std::string problem) {
    own.problem = std::move(problem);
    report(own.activity.c_str());
}

/// After a failure the picture stays. A lost device is opened anew, and rendering begins again; what else failed waits
/// for other wishes.
void RenderThread::recover(const std::exception& error) {
    endLastPass();
    log.write("failed", {{"cause", error.what()}});
    session->job.reset();
    midPass = false;
    session->draft.reset();
    const bool lost = dynamic_cast<const DeviceLost*>(&error) != nullptr;
    if (lost) gpu.reset();
    if (lost && ++losses > 3) throw DeviceLost(error.what());
    failed = true;
    halted = !lost;
    hasWork = lost;
    own.activity = lost ? "preparing" : "stopped";
    saySo(error.what());
}

} // namespace vkpm
