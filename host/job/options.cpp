/// What a command asks of a render.
#include "job/options.h"
#include "error.h"
#include "measure/report.h"
#include "output/used_files.h"
#include <fmt/format.h>
#include <utility>

namespace vkpm {

namespace fs = std::filesystem;

void requirePhotonMap(const SettingsOptions& options, uint integrator) {
    if (integrator == INTEGRATOR_PHOTON_MAP) return;
    for (const auto& [name, given] : {std::pair("--map", options.showCaustic), std::pair("--show", options.showPoints)})
        if (given)
            throw InputError(fmt::format("{}: found with --integrator {}; allowed: only with --integrator photon-map",
                                         name, integratorNames[integrator]));
}

Settings SettingsOptions::over(Settings settings) const {
    const auto set = [](auto& target, const auto& value) {
        if (value) target = *value;
    };
    set(settings.size, size);
    set(settings.integrator, integrator);
    set(settings.showCaustic, showCaustic);
    set(settings.showPoints, showPoints);
    set(settings.passes, passes);
    set(settings.photons, photons);
    set(settings.causticPhotons, causticPhotons);
    set(settings.pixelSamples, pixelSamples);
    set(settings.gatherRays, gatherRays);
    set(settings.radius, radius);
    set(settings.causticRadius, causticRadius);
    set(settings.nearest, nearest);
    set(settings.alpha, alpha);
    set(settings.kernel, kernel);
    set(settings.schlick, schlick);
    set(settings.layers, layers);
    set(settings.seed, seed);
    set(settings.allFeatures, allFeatures);
    requirePhotonMap(*this, settings.integrator);
    return settings;
}

Settings RenderOptions::settingsOf(const Settings& sceneSettings) const {
    Settings settings = over(sceneSettings);
    settings.labels = labels;
    const uint count = passRange ? passRange->end - passRange->begin : settings.passes;
    if (labels && (count != 1 || !(settings.layers >> ASK_ALBEDO & 1) ||
                   (settings.integrator != INTEGRATOR_PHOTON && settings.integrator != INTEGRATOR_DIRECT)))
        throw InputError(
            fmt::format("--labels: found with {} passes of --integrator {}; allowed: one pass of photon or "
                        "direct, with the layer albedo, in whose place they are",
                        count, integratorNames[settings.integrator]));
    if (targetError && (settings.layers & (1u << ASK_NOISE | 1u << ASK_BIAS)) != (1u << ASK_NOISE | 1u << ASK_BIAS))
        throw InputError(
            "--target-error: needs the layers noise and bias; allowed: with all layers, or with both in --layers");
    return settings;
}

fs::path pngBeside(fs::path exr) { return exr.replace_extension(".png"); }

void requireFilesApart(const RenderOptions& options, std::span<const fs::path> sceneFiles) {
    std::vector<UsedFile> written{{"--output", options.output}, {"--output's PNG", pngBeside(options.output)}}, read;
    if (options.stats) written.push_back({"--stats", *options.stats});
    if (options.log) written.push_back({"--log", *options.log});
    if (options.report)
        for (const char* name : Report::files) written.push_back({"--report", *options.report / name});
    for (const fs::path& file : sceneFiles)
        read.push_back({file == sceneFiles[0] ? "the scene" : "a file of the scene", file});
    if (options.reference) read.push_back({"--reference", *options.reference});
    requireApart(written, read);
}

} // namespace vkpm
