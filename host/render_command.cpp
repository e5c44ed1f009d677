/// vkpm --scene: a render without a window.
#include "commands.h"
#include "gpu/audit.h"
#include "output/atomic_file.h"
#include "output/error_estimate.h"
#include "output/event_log.h"
#include "output/film_image.h"
#include "output/film_runs.h"
#include "output/interrupt.h"
#include "output/progress.h"
#include "output/report.h"
#include "output/statistics.h"
#include "render/noise.h"
#include "render/radius.h"
#include "render/renderer.h"
#include "memory_advice.h"
#include "render_file.h"
#include "scene/explain.h"
#include "scene/identity.h"
#include "scene/settings_json.h"
#include <chrono>
#include <fmt/format.h>

namespace vkpm {
namespace {

const uint leastPassesForError = 8; // batches of two sizes, see render/noise.h

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

PhotonCounts countsOf(const PhotonLedger& l) {
    return {l.emitted, l.stored, l.absorbed, l.escaped, l.lost};
}

std::optional<GatherRadii> radiiOf(const std::optional<MapStages>& stages, bool given) {
    if (!stages) return {};
    if (!stages->field) return GatherRadii{stages->radius, stages->radius, stages->radius, given};
    const auto radius = [&](float logarithm) { return stages->radius * std::exp2(logarithm); };
    return GatherRadii{radius(stages->field->smallest), radius(stages->field->median), radius(stages->field->greatest), given};
}

/// "hasGlass: the scene has no glass", a line for each feature that the render needs, or does without.
std::vector<std::string> manifest(const Features& features, const Settings& settings, bool needed) {
    std::vector<std::string> lines;
    for (const FeatureReason& line : explainFeatures(features, settings))
        if (line.needed == needed) lines.push_back(line.name + ": " + line.reason);
    return lines;
}

/// One run of the program: a renderer with what was asked for, from the first pass to the saved file.
class Job {
public:
    Job(const Options& opts, const Scene& input, const Settings& set, Gpu& opened)
        : options(opts), scene(input), settings(set), gpu(opened), device(fmt::format("{}, {}", gpu.info().name, gpu.info().driver)), renderer(gpu, scene, settings), log(options.log, options.resume),
          identity(identityOf(scene, settings)), passes(options.passRange.value_or(PassRange{0, settings.passes})) {
        if (options.report) report.emplace(*options.report, options.reference, settings.size);
        if ((options.seconds || options.targetError) && !options.passes && !options.passRange) passes.end = NONE;
    }

    /// Goes on from what the output holds, if it is there.
    void resume();
    void renderPasses();
    int finish();

    Clock::time_point start;

private:
    void requireSame(const RenderFile& file) const;
    bool done() const;
    void estimate(Progress& progress);
    std::optional<ErrorEstimate> estimateOf(std::span<const Pixel> pixels) const;
    double elapsed() const { return secondsSince(begin) - reporting; }
    void sayWhatIsSaved() const;
    void addToReport();
    void finishReport(std::span<const Pixel> pixels) const;
    void checkpoint();
    void save(std::span<const Pixel> pixels);
    Statistics statistics() const;
    std::uint64_t rays() const;
    std::uint64_t nonfinite() const;
    std::optional<GatherRadii> globalRadii() const { return radiiOf(renderer.globalMap(), settings.radius.has_value()); }
    std::optional<GatherRadii> causticRadii() const { return radiiOf(renderer.causticMap(), settings.causticRadius.has_value()); }

    const Options& options;
    const Scene& scene;
    const Settings& settings;
    Gpu& gpu;
    std::string device; // as files and statistics name it
    Renderer renderer;
    EventLog log;
    std::map<std::string, std::string> identity;
    PassRange passes;
    uint restored = 0;              // passes that earlier runs rendered,
    uint savedPasses = 0;           // that the output holds
    double earlierSeconds = 0;      // the time they took,
    std::uint64_t earlierNonfinite = 0;
    Clock::time_point begin{};      // of rendering
    Clock::time_point saved{};      // last checkpoint
    double renderSeconds = 0;
    double reporting = 0;               // time that reports took, no part of rendering
    std::optional<ErrorEstimate> error; // the last estimate
    std::optional<Report> report;
};

std::uint64_t Job::rays() const {
    std::uint64_t count = renderer.rays().paths + renderer.rays().shadow;
    for (const MapKind kind : {MapKind::global, MapKind::caustic}) count += renderer.photons(kind).rays;
    return count;
}

std::uint64_t Job::nonfinite() const {
    std::uint64_t count = earlierNonfinite;
    for (const std::uint64_t layer : renderer.film.nonfinite()) count += layer;
    for (const MapKind kind : {MapKind::global, MapKind::caustic}) count += renderer.photons(kind).nonfinite;
    return count;
}

void Job::requireSame(const RenderFile& file) const {
    const std::vector<std::string> lines = differences(identity, file.header.attributes);
    if (!lines.empty())
        throw InputError(fmt::format("{}: --resume: was rendered from another scene or with other settings; what differs (here asked for, there in the file):\n  {}",
                                     file.path.string(), fmt::join(lines, "\n  ")));
    if (file.header.size != settings.size)
        throw InputError(fmt::format("{}: --resume: has {}x{} pixels, its settings say {}x{}; it was changed by another program", file.path.string(),
                                     file.header.size.x, file.header.size.y, settings.size.x, settings.size.y));
    const PassRange held = file.passes();
    const bool fits = held.begin == passes.begin && (!options.passRange || held.end <= passes.end);
    if (!fits)
        throw InputError(fmt::format("{}: --resume: holds {}; allowed: a file that begins with pass {}{}", file.path.string(), describe(held), passes.begin,
                                     options.passRange ? fmt::format(" and ends with pass {} or before", passes.end - 1) : ""));
}

void Job::resume() {
    if (!std::filesystem::exists(options.output)) return;
    const RenderFile file = openRender(options.output);
    requireSame(file);
    if (file.attribute("device") != device)
        fmt::print(stderr, "vkpm: warning: {} was rendered by {}, and goes on on {}: roundings may differ\n", options.output.string(), file.attribute("device"), device);
    restore(renderer.film, file);
    restored = savedPasses = renderer.film.passCount();
    earlierNonfinite = std::strtoull(file.attribute("nonfinite").c_str(), nullptr, 10);
    earlierSeconds = std::strtod(file.attribute("seconds").c_str(), nullptr);
    log.write("resume", {{"file", options.output.string()}, {"passes", {file.passes().begin, file.passes().end}}});
}

/// Whether the passes are there, or the time is nearer now than after another pass.
bool Job::done() const {
    const uint rendered = renderer.film.passCount() - restored;
    if (interrupted() || passes.begin + renderer.film.passCount() >= passes.end) return true;
    if (options.targetError && error && error->error <= *options.targetError) return true;
    return options.seconds && restored + rendered > 0 && elapsed() + 0.5 * elapsed() / std::max(rendered, 1u) >= *options.seconds;
}

/// Nothing while there are no batches of passes that could differ, or if nobody asked for noise.
std::optional<ErrorEstimate> Job::estimateOf(std::span<const Pixel> pixels) const {
    if (noiseFreedom(renderer.film.ranges()) == 0 || !(settings.layers >> ASK_NOISE & 1)) return {};
    return estimateError(pixels, settings.size);
}

/// Estimates the error at numbers of passes that grow by a quarter: a function of the passes alone, so that a render that is
/// resumed stops where one that was not would.
void Job::estimate(Progress& progress) {
    const uint count = renderer.film.passCount();
    uint due = leastPassesForError;
    while (due < count) due += (due + 3) / 4;
    if (!options.targetError || due != count) return;
    error = estimateOf(renderer.film.download());
    if (error) progress.estimate(error->error);
    if (error) log.write("error", {{"passes", count}, {"error", error->error}, {"noise", error->noise}, {"bias", error->bias}});
}

void Job::addToReport() {
    const auto before = Clock::now();
    const std::vector<Pixel> pixels = renderer.film.download();
    ReportRow row{.passes = renderer.film.passCount(), .seconds = earlierSeconds + elapsed(), .rays = rays(), .estimate = estimateOf(pixels)};
    for (const MapKind kind : {MapKind::global, MapKind::caustic}) row.photons += renderer.photons(kind).emitted;
    report->add(std::move(row), filmImage(pixels, settings.size, settings.layers));
    reporting += secondsSince(before);
}

void Job::finishReport(std::span<const Pixel> pixels) const {
    report->finish(filmImage(pixels, settings.size, settings.layers), develop(pixels, settings.exposure),
                   {{"scene", options.scene.string()}, {"settings", identity.at("settings")}, {"version", identity.at("version")}, {"device", device},
                    {"reference", options.reference ? options.reference->string() : "none"}});
}

void Job::renderPasses() {
    begin = saved = Clock::now();
    log.write("start", {{"scene", options.scene.string()}, {"settings", nlohmann::ordered_json::parse(settingsJson(settings))},
                        {"passes", {passes.begin, passes.end}}, {"device", gpu.info().name}, {"radius", radiiJson(globalRadii())},
                        {"causticRadius", radiiJson(causticRadii())}});
    Progress progress({passes.end == NONE ? NONE : passes.end - passes.begin, options.seconds.value_or(INFINITY), restored, options.targetError.value_or(0)}, options.quiet);
    if (restored > 0) estimate(progress);
    while (!done()) {
        const uint pass = passes.begin + renderer.film.passCount();
        try {
            renderer.renderPass(pass);
        } catch (const GpuError& failure) {
            log.write("failed", {{"pass", pass}, {"cause", failure.what()}, {"savedPasses", savedPasses}});
            sayWhatIsSaved();
            throw;
        }
        if (report && Report::due(renderer.film.passCount())) addToReport();
        estimate(progress);
        log.write("pass", {{"pass", pass}, {"rays", rays()}, {"radiusFactor", radiusFactor(pass, settings.alpha)}});
        progress.update(renderer.film.passCount(), rays());
        if (options.checkpoint && !done() && secondsSince(saved) >= *options.checkpoint) checkpoint();
    }
    renderSeconds = elapsed();
    if (report && renderer.film.passCount() > 0) addToReport();
}

void Job::sayWhatIsSaved() const {
    const std::string file = options.output.string();
    if (savedPasses > 0) fmt::print(stderr, "vkpm: {} holds the first {} of {} passes rendered; the same command with --resume goes on from there\n", file, savedPasses, renderer.film.passCount());
    else if (renderer.film.passCount() > 0) fmt::print(stderr, "vkpm: {} passes are lost; with --checkpoint SECONDS they are saved on the way\n", renderer.film.passCount());
}

/// Saves on the way; if that fails, what there is on disk stays, and the render goes on.
void Job::checkpoint() {
    try {
        save(renderer.film.download());
        savedPasses = renderer.film.passCount();
        log.write("checkpoint", {{"file", options.output.string()}, {"passes", renderer.film.passCount()}});
    } catch (const std::runtime_error& failure) {
        fmt::print(stderr, "vkpm: warning: checkpoint: {}; rendering goes on\n", failure.what());
        log.write("checkpoint failed", {{"cause", failure.what()}});
    }
    saved = Clock::now();
}

void Job::save(std::span<const Pixel> pixels) {
    std::map<std::string, std::string> attributes = identity;
    attributes["device"] = device;
    attributes["needed"] = fmt::format("{}", fmt::join(manifest(renderer.features(), settings, true), "; "));
    attributes["leftOut"] = fmt::format("{}", fmt::join(manifest(renderer.features(), settings, false), "; "));
    attributes["nonfinite"] = std::to_string(nonfinite());
    // Without the time, two runs write the same file bit for bit; who asks for statistics gets it.
    if (options.stats) attributes["seconds"] = fmt::format("{:.3f}", earlierSeconds + secondsSince(begin));
    saveRender(options.output, renderer.film, pixels, settings, std::move(attributes));
}

Statistics Job::statistics() const {
    Statistics s{.device = device, .seed = settings.seed, .passes = renderer.film.passCount()};
    for (const auto& [name, time] : gpu.times) s.stages.emplace_back(name, time.seconds);
    for (const auto& [name, bytes] : gpu.memory)
        if (bytes > 0) s.buffers.emplace_back(name, bytes);
    s.deviceBytes = gpu.peakBytes;
    s.rays = rays();
    s.global = countsOf(renderer.photons(MapKind::global));
    s.caustic = countsOf(renderer.photons(MapKind::caustic));
    s.globalRadii = globalRadii();
    s.causticRadii = causticRadii();
    s.radiusFactor = radiusFactor(renderer.film.passes().end - 1, settings.alpha);
    s.features = renderer.features();
    s.needed = manifest(renderer.features(), settings, true);
    s.leftOut = manifest(renderer.features(), settings, false);
    s.error = error;
    s.nonfinite = nonfinite();
    s.setupSeconds = std::chrono::duration<double>(begin - start).count();
    s.renderSeconds = renderSeconds;
    s.totalSeconds = secondsSince(start);
    return s;
}

int Job::finish() {
    if (renderer.film.passCount() == 0) return 130; // nothing to save: an older picture stays
    if (nonfinite())
        fmt::print(stderr, "vkpm: warning: {} samples were not finite and count as black; see nonfinite in --stats\n", nonfinite());
    for (const MapKind kind : {MapKind::global, MapKind::caustic})
        if (const std::uint64_t lost = renderer.photons(kind).lost)
            fmt::print(stderr, "vkpm: warning: {} photons were still under way after {} bounces and were left: the picture is too dark; a closed scene that absorbs nothing has no finite light\n", lost, maxBounces);
    const std::vector<Pixel> pixels = renderer.film.download();
    save(pixels);
    error = estimateOf(pixels);
    if (report) finishReport(pixels);
    if (error && !options.quiet) fmt::print(stderr, "{}\n", describe(*error));
    log.write("end", {{"file", options.output.string()}, {"passes", renderer.film.passCount()}, {"interrupted", interrupted()}});
    if (options.stats) writeStatistics(*options.stats, statistics());
    return interrupted() ? 130 : 0;
}

} // namespace

int render(const Options& options) {
    const auto start = Clock::now();
    const Scene scene = loadScene(options.scene);
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "vkpm: warning: {}\n", warning);
    const Settings settings = options.override(scene.settings);

    requireWritable(options.output);
    requireWritable(pngBeside(options.output));
    if (options.stats) requireWritable(*options.stats);

    Gpu gpu(options.device);
    gpu.timesKernels = options.stats.has_value();
    requireSoundDriver(gpu);
    return adviseOnMemory(gpu, scene, settings, [&] {
        Job job(options, scene, settings, gpu);
        job.start = start;
        if (options.resume) job.resume();
        job.renderPasses();
        return job.finish();
    });
}

} // namespace vkpm
