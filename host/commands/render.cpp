/// vkpm --scene: a render without a window.
#include "commands/commands.h"
#include "gpu/audit.h"
#include "interrupt.h"
#include "job/memory_advice.h"
#include "job/render_job.h"
#include "output/atomic_file.h"
#include "output/messages.h"
#include "output/progress.h"
#include "render/explain.h"

namespace vkpm {

static void renderPasses(RenderJob& job, const RenderOptions& options) {
    const PassRange passes = job.passesWanted();
    Progress progress({passes.end == NONE ? NONE : passes.end - passes.begin, options.seconds.value_or(INFINITY),
                       job.restoredPasses(), options.targetError.value_or(0)},
                      options.quiet);
    onInterrupt("interrupted: finishing this pass, then saving; once more stops at once", false);
    while (!job.done()) {
        job.renderPass();
        if (job.lastError()) progress.estimate(job.lastErrorPasses(), job.lastError()->error);
        progress.update(job.passCount(), job.rays());
    }
}

int execute(const RenderOptions& options) {
    const auto start = Clock::now();
    onInterrupt("interrupted before the first pass: nothing to save", true);
    const Scene scene = loadScene(options.scene);
    for (const std::string& warning : scene.warnings) warn(warning);
    requireFilesApart(options, scene.files);
    const Settings settings = options.settingsOf(scene.settings);
    if (const std::string blind = blindness(scene, settings); !blind.empty()) warn(blind);

    requireWritable(options.output);
    requireWritable(pngBeside(options.output));
    if (options.stats) requireWritable(*options.stats);

    Gpu gpu(options.device);
    gpu.timesKernels = options.stats.has_value();
    requireSoundDriver(gpu);
    EventLog log(options.log, options.resume);
    log.open();
    for (const std::string& warning : scene.warnings) log.write("warning", {{"text", warning}});
    return adviseOnMemory(gpu, scene, settings, [&] {
        RenderJob job(options, scene, settings, gpu, log, start);
        if (options.resume) job.resume();
        job.begin();
        renderPasses(job, options);
        if (!job.finish()) return 130;
        if (settings.autoExposure && !options.quiet)
            say("the PNG shows an exposure of {0} stops, by the picture's brightness; "
                "\"film\": {{\"exposure\": {0}}} keeps it",
                job.exposure());
        return interrupted() ? 130 : 0;
    });
}

} // namespace vkpm
