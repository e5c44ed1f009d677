/// Passes, what is due between them, and files.
#include "job/render_job.h"
#include "interrupt.h"
#include "output/film_image.h"
#include "output/film_runs.h"
#include "output/messages.h"
#include "render/explain.h"
#include "render/noise.h"
#include "render/radius.h"
#include "scene/box.h"
#include "scene/identity.h"
#include "scene/settings_json.h"
#include <fmt/format.h>

namespace vkpm {
namespace {

const uint minPassesForError = 8; // batches of two sizes, see render/noise.h

std::optional<GatherRadii> radiiOf(const std::optional<PhotonMapStage>& map, bool given, double unit) {
    if (!map) return {};
    const auto inWorld = [&](float radius) { return static_cast<float>(unit * double{radius}); };
    return GatherRadii{inWorld(map->smallestRadius()), inWorld(map->medianRadius()), inWorld(map->greatestRadius()),
                       given};
}

/// "hasGlass: the scene has no glass", a line for each feature that the render needs, or does without.
std::vector<std::string> manifest(const Features& features, const Settings& settings, bool needed) {
    std::vector<std::string> lines;
    for (const FeatureReason& line : explainFeatures(features, settings))
        if (line.needed == needed) lines.push_back(line.name + ": " + line.reason);
    return lines;
}

} // namespace

RenderJob::RenderJob(const RenderOptions& opts, const Scene& input, const Settings& set, Gpu& opened, EventLog& events,
                     Clock::time_point begun)
    : renderer(opened, input, set), options(opts), scene(input), settings(set), gpu(opened), log(events), start(begun),
      device(fmt::format("{}, {}", gpu.info().name, gpu.info().driver)), identity(identityOf(scene, settings)),
      passes(options.passRange.value_or(PassRange{0, settings.passes})) {
    openReport();
    if ((options.seconds || options.targetError || options.isEndless) && !options.passes && !options.passRange)
        passes.end = NONE;
}

void RenderJob::openReport() {
    if (options.report) report.emplace(*options.report, options.reference, settings.size);
}

void RenderJob::requireSize(uvec2 size) const {
    if (report) report->requireSize(size);
}

std::uint64_t RenderJob::rays() const {
    std::uint64_t count = renderer.rays().paths + renderer.rays().shadow;
    for (const MapKind kind : {MapKind::global, MapKind::caustic}) count += renderer.photons(kind).rays;
    return count;
}

std::uint64_t RenderJob::photons() const {
    return renderer.photons(MapKind::global).emitted + renderer.photons(MapKind::caustic).emitted;
}

std::optional<GatherRadii> RenderJob::globalRadii() const {
    return radiiOf(renderer.globalMap(), settings.radius.has_value(), scene.coordinates.unit);
}

std::optional<GatherRadii> RenderJob::causticRadii() const {
    return radiiOf(renderer.causticMap(), settings.causticRadius.has_value(), scene.coordinates.unit);
}

std::uint64_t RenderJob::nonfinite() const {
    std::uint64_t count = earlierNonfinite;
    for (const std::uint64_t layer : renderer.film.nonfinite()) count += layer;
    for (const MapKind kind : {MapKind::global, MapKind::caustic}) count += renderer.photons(kind).nonfinite;
    return count;
}

void RenderJob::requireSame(const RenderFile& file) const {
    const std::vector<std::string> lines = differences(identity, file.header.attributes);
    if (!lines.empty())
        throw InputError(fmt::format("{}: --resume: was rendered from another scene or with other settings; what "
                                     "differs (here asked for, there in the file):\n  {}",
                                     file.path.string(), fmt::join(lines, "\n  ")));
    if (file.header.size != settings.size)
        throw InputError(
            fmt::format("{}: --resume: has {}x{} pixels, its settings say {}x{}; it was changed by another program",
                        file.path.string(), file.header.size.x, file.header.size.y, settings.size.x, settings.size.y));
    const PassRange held = file.passes();
    const bool fits = held.begin == passes.begin && (!options.passRange || held.end <= passes.end);
    if (!fits)
        throw InputError(fmt::format(
            "{}: --resume: holds {}; allowed: a file that begins with pass {}{}", file.path.string(), describe(held),
            passes.begin, options.passRange ? fmt::format(" and ends with pass {} or before", passes.end - 1) : ""));
}

void RenderJob::resume() {
    if (!std::filesystem::exists(options.output)) return;
    const RenderFile file = openRender(options.output);
    requireSame(file);
    if (file.attribute("device") != device)
        warn(fmt::format("{} was rendered by {}, and goes on on {}: roundings may differ", options.output.string(),
                         file.attribute("device"), device));
    restore(renderer.film, file);
    restored = savedPasses = passCount();
    earlierNonfinite = std::strtoull(file.attribute("nonfinite").c_str(), nullptr, 10);
    earlierSeconds = std::strtod(file.attribute("seconds").c_str(), nullptr);
    log.write("resume", {{"file", options.output.string()}, {"passes", {file.passes().begin, file.passes().end}}});
}

bool RenderJob::done() const {
    const uint rendered = passCount() - restored;
    if (interrupted() || passes.begin + passCount() >= passes.end) return true;
    if (options.targetError && (hopeless || (error && error->error <= *options.targetError))) return true;
    return options.seconds && restored + rendered > 0 &&
           elapsed() + 0.5 * elapsed() / std::max(rendered, 1u) >= *options.seconds;
}

bool RenderJob::missesPhotons() const {
    const PhotonLedger global = renderer.photons(MapKind::global), caustic = renderer.photons(MapKind::caustic);
    return global.emitted + caustic.emitted > 0 && global.stored + caustic.stored == 0;
}

std::optional<ErrorEstimate> RenderJob::estimateNow() const {
    if (missesPhotons() || noiseFreedom(renderer.film.ranges()) == 0 || !(settings.layers >> ASK_NOISE & 1)) return {};
    return estimateError([&](uint row, uint rows) { return renderer.film.pixels(row, rows); }, settings.size);
}

/// Estimates the error at numbers of passes that grow by a quarter: a function of the passes alone, so that a render
/// that is resumed stops where one that was not would.
void RenderJob::estimate() {
    const uint count = passCount();
    uint due = minPassesForError;
    while (due < count) due += (due + 3) / 4;
    if (!options.targetError || due != count) return;
    error = estimateNow();
    errorPasses = count;
    hopeless = missesPhotons();
    if (error)
        log.write("error", {{"passes", count},
                            {"seconds", seconds()},
                            {"error", error->error},
                            {"noise", error->noise},
                            {"bias", error->bias},
                            {"specks", error->specks}});
}

void RenderJob::addToReport() {
    const auto before = Clock::now();
    report->add(
        {.passes = passCount(), .seconds = seconds(), .rays = rays(), .photons = photons(), .estimate = estimateNow()},
        filmImage(renderer.film.download(), settings.size, settings.layers));
    reporting += secondsSince(before);
}

float RenderJob::exposure() const { return exposureOf(renderer.film, settings); }

void RenderJob::finishReport() const {
    const std::vector<Pixel> pixels = renderer.film.download();
    report->finish({filmImage(pixels, settings.size, settings.layers), develop(pixels, exposureOf(settings, pixels)),
                    pixels, noiseFreedom(renderer.film.ranges())},
                   {{"scene", options.scene.string()},
                    {"settings", identity.at("settings")},
                    {"version", identity.at("version")},
                    {"device", device},
                    {"reference", options.reference ? options.reference->string() : "none"}});
}

void RenderJob::begin() {
    beginning = saved = Clock::now();
    log.write("start", {{"scene", options.scene.string()},
                        {"settings", nlohmann::ordered_json::parse(settingsJson(settings))},
                        {"passes", {passes.begin, passes.end}},
                        {"device", gpu.info().name},
                        {"radius", radiiJson(globalRadii())},
                        {"causticRadius", radiiJson(causticRadii())}});
    if (restored > 0) estimate();
}

void RenderJob::restart() {
    renderer.setView(scene.view, settings.size);
    identity = identityOf(scene, settings);
    restored = savedPasses = 0;
    earlierSeconds = reporting = 0;
    earlierNonfinite = 0;
    error.reset();
    openReport();
    begin();
}

void RenderJob::renderPass() {
    const uint pass = passes.begin + passCount();
    try {
        renderer.renderPass(pass);
    } catch (const GpuError& failure) {
        log.write("failed", {{"pass", pass}, {"cause", failure.what()}, {"savedPasses", savedPasses}});
        sayWhatIsSaved();
        throw;
    }
    if (report && Report::due(passCount())) addToReport();
    estimate();
    log.write("pass", {{"pass", pass}, {"rays", rays()}, {"radiusFactor", radiusFactor(pass, settings.alpha)}});
    if (options.checkpoint && !done() && secondsSince(saved) >= *options.checkpoint) checkpoint();
}

void RenderJob::sayWhatIsSaved() const {
    const std::string file = options.output.string();
    if (savedPasses > 0)
        say("{} holds the first {} of {} passes rendered; the same command with --resume goes on from there", file,
            savedPasses, passCount());
    else if (passCount() > 0)
        say("{} passes are lost; with --checkpoint SECONDS they are saved on the way", passCount());
}

/// Saves on the way; if that fails, what there is on disk stays, and the render goes on.
void RenderJob::checkpoint() {
    try {
        save();
        savedPasses = passCount();
        log.write("checkpoint", {{"file", options.output.string()}, {"passes", passCount()}});
    } catch (const std::runtime_error& failure) {
        warn(fmt::format("checkpoint: {}; rendering goes on", failure.what()));
        log.write("checkpoint failed", {{"cause", failure.what()}});
    }
    saved = Clock::now();
}

void RenderJob::save() {
    std::map<std::string, std::string> attributes = identity;
    attributes["device"] = device;
    attributes["needed"] = fmt::format("{}", fmt::join(manifest(renderer.features(), settings, true), "; "));
    attributes["leftOut"] = fmt::format("{}", fmt::join(manifest(renderer.features(), settings, false), "; "));
    attributes["nonfinite"] = std::to_string(nonfinite());
    // Without the time, two runs write the same file bit for bit; who asks for statistics gets it.
    if (options.stats) attributes["seconds"] = fmt::format("{:.3f}", earlierSeconds + secondsSince(beginning));
    saveRender(options.output, renderer.film, settings, std::move(attributes),
               {.sums = !options.withoutSums, .half = options.half});
}

Statistics RenderJob::statistics() const {
    Statistics s{.device = device, .seed = settings.seed, .passes = passCount()};
    for (const auto& [name, time] : gpu.times) s.stages.emplace_back(name, time.seconds);
    for (const auto& [name, bytes] : gpu.memory)
        if (bytes > 0) s.buffers.emplace_back(name, bytes);
    s.deviceBytes = gpu.peakBytes;
    s.rays = rays();
    s.waits = renderer.work().waits;
    s.dispatches = renderer.work().dispatches;
    s.global = renderer.photons(MapKind::global);
    s.caustic = renderer.photons(MapKind::caustic);
    s.globalRadii = globalRadii();
    s.causticRadii = causticRadii();
    s.radiusFactor = radiusFactor(renderer.film.passes().end - 1, settings.alpha);
    s.features = renderer.features();
    s.needed = manifest(renderer.features(), settings, true);
    s.leftOut = manifest(renderer.features(), settings, false);
    s.error = error;
    s.noiseFreedom = noiseFreedom(renderer.film.ranges());
    s.nonfinite = nonfinite();
    s.warnings = warnings();
    s.setupSeconds = std::chrono::duration<double>(beginning - start).count();
    s.renderSeconds = renderSeconds;
    s.totalSeconds = secondsSince(start);
    return s;
}

void RenderJob::tell(const std::string& warning) {
    warn(warning);
    log.write("warning", {{"text", warning}});
}

/// Whether no pixel has light; a few rows tell of most pictures.
bool RenderJob::isBlack() const {
    if ((settings.layers & ((1u << LAYER_COUNT) - 1)) == 0) return false; // nobody asked for light
    const auto isDark = [](const Pixel& pixel) {
        return std::ranges::all_of(pixel.mean.layers, [](vec3 light) { return light == vec3{0}; });
    };
    const uint height = settings.size.y;
    for (const uint step : {std::max(1u, height / 16), 1u})
        for (uint row = 0; row < height; row += step)
            if (!std::ranges::all_of(renderer.film.pixels(row, 1), isDark)) return false;
    return true;
}

void RenderJob::warnOfDarkness() {
    if (missesPhotons())
        tell("no photon arrived anywhere, so that indirect light and caustics are missing and no error is stated; do "
             "the lamps shine away from everything "
             "(a rectangle emits on the side of u x v, with \"twoSided\" on both), or are they inside something?");
    else if (isBlack())
        tell("the picture is black: nothing that the camera sees is lit; is the camera, or a lamp, inside something?");
}

void RenderJob::warnOfBlur() {
    const std::optional<PhotonMapStage>& map = renderer.causticMap();
    if (!map || !map->roundingBinds()) return;
    const auto inWorld = [&](double length) { return scene.coordinates.unit * length; };
    tell(fmt::format(
        "caustics are blurred by discs of {:.3g} at least, though photons are dense enough for narrower ones: "
        "coordinates reach {:.3g} from the middle of "
        "the scene, with the digits of 32-bit floats; leave out what lies far from the caustics, or move it nearer",
        inWorld(map->smallestRadius()), inWorld(reachOf(scene.bounds))));
}

bool RenderJob::finish() {
    renderSeconds = elapsed();
    if (passCount() == 0) return false;
    if (report) addToReport();
    if (nonfinite())
        tell(fmt::format("{} samples were not finite and count as black; see nonfinite in --stats", nonfinite()));
    for (const MapKind kind : {MapKind::global, MapKind::caustic})
        if (const std::uint64_t lost = renderer.photons(kind).lost)
            tell(fmt::format("{} photons were still under way after {} bounces and were left: the picture is too dark; "
                             "a closed scene that absorbs nothing has no finite light",
                             lost, MAX_BOUNCES));
    if (const uint overflows = renderer.mediaOverflows())
        tell(fmt::format("paths entered a fifth medium {} times, and forgot the one that counts least: glass lies in "
                         "glass too often; leave gaps between shapes, or join them",
                         overflows));
    warnOfDarkness();
    warnOfBlur();
    save();
    error = estimateNow();
    if (report) finishReport();
    if (error && !options.quiet) writeText(stderr, describe(*error) + "\n");
    log.write("end", {{"file", options.output.string()}, {"passes", passCount()}, {"interrupted", interrupted()}});
    if (options.stats) writeStatistics(*options.stats, statistics());
    return true;
}

} // namespace vkpm
