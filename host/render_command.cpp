/// vkpm --scene: a render without a window.
#include "commands.h"
#include "gpu/audit.h"
#include "output/atomic_file.h"
#include "output/exr.h"
#include "output/film_image.h"
#include "output/interrupt.h"
#include "output/png.h"
#include "output/progress.h"
#include "output/statistics.h"
#include "render/radius.h"
#include "render/renderer.h"
#include "scene/settings_json.h"
#include <chrono>
#include <fmt/format.h>

namespace vkpm {

using Clock = std::chrono::steady_clock;

static double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

static PhotonCounts countsOf(const std::optional<MapStages>& stages) {
    if (!stages) return {};
    const PhotonLedger& l = stages->ledger;
    return {l.emitted, l.stored, l.absorbed, l.escaped, l.lost};
}

static std::uint64_t raysOf(const Renderer& renderer) {
    std::uint64_t rays = renderer.rays().paths + renderer.rays().shadow;
    for (const auto* stages : {&renderer.globalMap(), &renderer.causticMap()})
        if (*stages) rays += (*stages)->ledger.rays;
    return rays;
}

static std::uint64_t nonfiniteOf(const Renderer& renderer) {
    std::uint64_t count = 0;
    for (const std::uint64_t layer : renderer.film.nonfinite()) count += layer;
    for (const auto* stages : {&renderer.globalMap(), &renderer.causticMap()})
        if (*stages) count += (*stages)->ledger.nonfinite;
    return count;
}

static Statistics statisticsOf(const Gpu& gpu, const Renderer& renderer, const Settings& settings) {
    Statistics s{.device = fmt::format("{}, {}", gpu.info().name, gpu.info().driver), .seed = settings.seed, .passes = renderer.passes()};
    for (const auto& [name, time] : gpu.times) s.stages.emplace_back(name, time.seconds);
    for (const auto& [name, bytes] : gpu.memory)
        if (bytes > 0) s.buffers.emplace_back(name, bytes);
    s.deviceBytes = gpu.peakBytes;
    s.rays = raysOf(renderer);
    s.global = countsOf(renderer.globalMap());
    s.caustic = countsOf(renderer.causticMap());
    s.features = renderer.features();
    s.leftOut = renderer.leftOut();
    s.nonfinite = nonfiniteOf(renderer);
    return s;
}

static void save(const Options& options, const Scene& scene, Renderer& renderer, const Settings& settings, const Statistics& statistics) {
    Image image = filmImage(renderer.film.download(), settings.size, renderer.passes());
    image.attributes = {{"version", VKPM_VERSION},
                        {"scene", scene.text},
                        {"settings", settingsJson(settings)},
                        {"settingsHash", hashText(scene.text + settingsJson(settings))},
                        {"seed", std::to_string(settings.seed)},
                        {"passes", std::to_string(renderer.passes())},
                        {"device", statistics.device}};
    // Without the time, two runs write the same file bit for bit; who asks for statistics gets it.
    if (options.stats) image.attributes["seconds"] = fmt::format("{:.3f}", statistics.renderSeconds);
    writeExr(options.output, image);
    std::filesystem::path png = options.output;
    writePng(png.replace_extension(".png"), settings.size, renderer.film.develop(settings.exposure));
    if (options.stats) writeStatistics(*options.stats, statistics);
}

int render(const Options& options) {
    const auto start = Clock::now();
    const Scene scene = loadScene(options.scene);
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "vkpm: warning: {}\n", warning);
    const Settings settings = chooseRadii(scene, options.override(scene.settings));

    requireWritable(options.output);
    if (options.stats) requireWritable(*options.stats);

    Gpu gpu(options.device);
    requireSoundDriver(gpu);
    Renderer renderer(gpu, scene, settings);
    const auto begin = Clock::now();
    {
        Progress progress(settings.passes, options.quiet);
        while (renderer.passes() < settings.passes && !interrupted()) {
            renderer.renderPass();
            progress.update(renderer.passes(), raysOf(renderer));
        }
    }

    if (renderer.passes() == 0) return 130; // nothing to save: an older picture stays

    Statistics statistics = statisticsOf(gpu, renderer, settings);
    statistics.renderSeconds = secondsSince(begin);
    statistics.setupSeconds = std::chrono::duration<double>(begin - start).count();
    statistics.totalSeconds = secondsSince(start);
    if (statistics.nonfinite)
        fmt::print(stderr, "vkpm: warning: {} samples were not finite and were left out; see nonfinite in --stats\n", statistics.nonfinite);
    save(options, scene, renderer, settings, statistics);
    return interrupted() ? 130 : 0;
}

} // namespace vkpm
