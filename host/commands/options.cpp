/// The command line.
#include "commands/options.h"
#include "commands/option_parser.h"
#include "error.h"
#include "measure/layer_error.h"
#include "scene/settings.h"
#include <array>

namespace vkpm {
namespace {

void addDevice(Parser& parser, std::string& device) {
    parser.add("--device", "INDEX|NAME", "Vulkan device by number or part of its name (default: the best)", device);
}

void addMachine(Parser& parser, RenderOptions& options) {
    parser.words("--features", std::array{"scene", "all"},
                 "compile kernels for this scene, or with everything switched on", options.allFeatures, 0);
    addDevice(parser, options.device);
}

void addFiles(Parser& parser, RenderOptions& options) {
    parser.group("Files");
    parser.add("--scene", "FILE", "scene to render (JSON), or a model (.glb, .gltf); required", options.scene, sceneOf);
    parser.add("-o,--output", "FILE.exr", "image; a PNG is written beside it (default: the scene's name, here)",
               options.output, exrOf);
    parser.add("--stats", "FILE.json", "what the render did: seconds, rays, photons, memory", options.stats, outputOf);
    parser.add("--report", "FOLDER", "error against run time while rendering: error.csv, and a page index.html",
               options.report);
    parser.add("--reference", "FILE.exr",
               "what --report measures the error against; without it, the render's own estimates", options.reference);
    parser.add("--log", "FILE.jsonl", "what happens and when, a JSON object per line", options.log, outputOf);
    parser.flag("--resume", "go on from what --output holds, if it is there", options.resume);
    parser.flag("--no-resume",
                "save the picture and its layers alone, in half the bytes, without the sums from which --resume and "
                "merge go on",
                options.withoutSums);
    parser.flag("--half", "save layers, but for depth, as 16-bit floats", options.half);
    parser.add("--checkpoint", "SECONDS", "save every so often (default: only at the end)", options.checkpoint,
               secondsOf);
}

void addImage(Parser& parser, RenderOptions& options, const Settings& defaults, const std::string& passes) {
    parser.group("Image (overrides the scene file, which overrides the defaults)");
    parser.add("--size", "WxH", fmt::format("pixels (default {}x{})", defaults.size.x, defaults.size.y), options.size,
               sizeOf);
    parser.count("--passes", "passes over the whole image", passes, options.passes, 1);
    parser.add("--time", "SECONDS",
               "of rendering, to the nearest pass; ends at --passes if that is given and comes first", options.seconds,
               secondsOf);
    parser.add("--target-error", "E",
               "stated error, such as 0.01 or 1%, 90 % sure, without the worst 2 %; ends there, or at --passes or "
               "--time if given",
               options.targetError, errorOf);
    parser.add("--pass-range", "A:B", "render only the passes A to B-1, a part for vkpm merge", options.passRange,
               passRangeOf);
    parser.count("--seed", "seed of the random numbers", defaults.seed, options.seed, 0, NONE);
    parser.words("--integrator", integratorNames, "how light is found", options.integrator, defaults.integrator);
    parser.words("--map", mapNames, "photon-map: which map", options.showCaustic, defaults.showCaustic);
    parser.words("--show", showNames, "photon-map: as what", options.showPoints, defaults.showPoints);
    parser.words("--fresnel", fresnelNames, "reflectance of glass", options.schlick, defaults.schlick);
    parser.add("--layers", "A,B,...",
               fmt::format("render only these; beauty is the sum of the lights' parts among them: {} (default all)",
                           fmt::join(layerNames, ", ")),
               options.layers, layersOf);
}

void addPhotons(Parser& parser, RenderOptions& options, const Settings& defaults) {
    parser.group("Photons (likewise)");
    parser.count("--photons", "emitted per pass", defaults.photons, options.photons);
    parser.count("--caustic-photons", "aimed at specular shapes per pass", defaults.causticPhotons,
                 options.causticPhotons);
    parser.count("--pixel-samples",
                 fmt::format("paths from the eye for each pixel, per pass, 1 to {}", maxPixelSamples),
                 defaults.pixelSamples, options.pixelSamples, 1, maxPixelSamples);
    parser.count("--gather-rays", fmt::format("from where the first of these ends, per pass, 1 to {}", maxGatherRays),
                 defaults.gatherRays, options.gatherRays, 1, maxGatherRays);
    parser.add("--radius", "R", "first gather radius, world units (default: measured by a pilot pass)", options.radius,
               radiusOf);
    parser.add("--caustic-radius", "R", "the same for caustics", options.causticRadius, radiusOf);
    parser.count("--nearest", "first radius: that of the N nearest; 0: one for all", defaults.nearest, options.nearest);
    parser.add("--alpha", "A",
               fmt::format("how fast radii shrink from pass to pass; 1: not at all (default {:.3})", defaults.alpha),
               options.alpha, alphaOf);
    parser.words("--kernel", kernelNames, "of the density estimate", options.kernel, defaults.kernel);
}

const char* const COMMANDS = R"(Commands (vkpm COMMAND --help says what they take):
  render                         render without a window; may be left out
  view --scene FILE [options]    the same render in a window, progressively
  plan --scene FILE [--json]     say what a scene needs, what is left out and why, memory by buffer
  compare IMAGE REFERENCE [--json]
                                 error measures between two EXR files, layer by layer
  merge OUT.exr PART.exr...      put parts that --pass-range rendered together
  devices [--json]               list the Vulkan devices and what each lacks
  bench [--json] [--scene FILE] [--device INDEX|NAME]
                                 measure rays, sort, gather and memory rates
  bench --features SCENE.json... [--json] [--device INDEX|NAME]
                                 what leaving out saves: start-up, time, memory

Counts may be written as 200000 or 2e5.

Exit codes:
  0    done
  1    the environment failed: no device, disk full, out of memory
  2    the command line or an input file is wrong
  130  interrupted (Ctrl-C or SIGTERM); everything rendered so far is saved)";

void requireRender(RenderOptions& options) {
    if (options.scene.empty())
        throw InputError(fmt::format("--scene: missing; allowed: a scene file, as in vkpm{} --scene FILE",
                                     options.isEndless ? " view" : ""));
    if (options.output.empty()) options.output = valueOf("--output", options.scene.stem().string() + ".exr", exrOf);
    requireFilesApart(options, std::array{options.scene});
    if (options.passRange && options.passes && options.passRange->end > *options.passes)
        refuse("--pass-range", fmt::format("{}:{}", options.passRange->begin, options.passRange->end),
               fmt::format("passes below the {} of --passes", *options.passes));
    if (options.reference && !options.report)
        refuse("--reference", options.reference->string(), "only with --report FOLDER, which shows what is measured");
    if (options.integrator) requirePhotonMap(options, *options.integrator);
    const auto needsSums = [&](const char* name, bool given) {
        if (given && options.withoutSums)
            throw InputError(fmt::format("{}: found with --no-resume; allowed: one of the two, since it needs the sums "
                                         "that --no-resume leaves out",
                                         name));
    };
    needsSums("--resume", options.resume);
    needsSums("--checkpoint", options.checkpoint.has_value());
    needsSums("--pass-range", options.passRange.has_value());
}

const char* const WINDOW = R"(Renders until --passes, --time or --target-error, without these until the window is
closed. Closing it saves --output with all finished passes, the file that
vkpm --scene FILE --passes N writes. The panel lists keys and mouse; Tab hides it.
Without a display the exit code is 1.)";

/// Of render and of view, which differ in when they end.
template <class Asked> Options parseRender(std::span<const std::string> arguments) {
    Asked options;
    const bool window = std::is_same_v<Asked, ViewOptions>;
    options.isEndless = window;
    Parser parser(window ? "Render a scene in a window, progressively."
                         : "vkpm, a photon mapping renderer in Vulkan compute.",
                  window ? "vkpm view --scene FILE [options]" : "vkpm [render] --scene FILE [options]");
    const Settings defaults;
    addFiles(parser, options);
    addImage(parser, options, defaults, window ? "no end" : std::to_string(defaults.passes));
    addPhotons(parser, options, defaults);
    parser.group("Machine");
    addMachine(parser, options);
    if (!window)
        parser.flag("--labels", "of one pass, say which path brought each pixel most: see tools/study specks",
                    options.labels);
    parser.flag("--quiet", "no progress on stderr", options.quiet);
    parser.footer(window ? WINDOW : COMMANDS);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    requireRender(options);
    return options;
}

Options parsePlan(std::span<const std::string> arguments) {
    PlanOptions options;
    const Settings defaults;
    Parser parser("Say what a scene needs, what is left out and why, and how much memory it takes. Renders one pass.",
                  "vkpm plan --scene FILE [options]");
    parser.add("--scene", "FILE", "scene (JSON) or model (.glb, .gltf); required", options.scene, sceneOf);
    parser.flag("--json", "as JSON", options.json);
    addImage(parser, options, defaults, std::to_string(defaults.passes));
    addPhotons(parser, options, defaults);
    parser.group("Machine");
    addMachine(parser, options);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    if (options.scene.empty())
        throw InputError("--scene: missing; allowed: a scene file, as in vkpm plan --scene FILE");
    return options;
}

Options parseCompare(std::span<const std::string> arguments) {
    CompareOptions options;
    Parser parser("Measure how far an image is off a reference, layer by layer. Needs no device.",
                  "vkpm compare IMAGE REFERENCE [--json]");
    parser.files("the image, then its reference (EXR)", [&](auto& values) {
        if (values.size() != 2)
            throw InputError(fmt::format("compare: found {} file{}; allowed: two, as in vkpm compare IMAGE REFERENCE",
                                         values.size(), values.size() == 1 ? "" : "s"));
        options.image = values[0];
        options.reference = values[1];
    });
    parser.flag("--json", "as JSON, with null for what cannot be said", options.json);
    parser.footer(MEASURES);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    return options;
}

Options parseMerge(std::span<const std::string> arguments) {
    MergeOptions options;
    Parser parser("Put parts of one render, made with --pass-range, together.",
                  "vkpm merge OUT.exr PART.exr... [options]");
    parser.files("the merged image, then its parts in any order", [&](auto& values) {
        if (values.size() < 2)
            throw InputError("merge: found fewer than two files; allowed: vkpm merge OUT.exr PART.exr...");
        options.output = valueOf("OUT.exr", values[0], exrOf);
        options.parts.assign(values.begin() + 1, values.end());
    });
    parser.flag("--part", "allow a result that does not begin with pass 0", options.isPart);
    addDevice(parser, options.device);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    return options;
}

Options parseDevices(std::span<const std::string> arguments) {
    DevicesOptions options;
    Parser parser("List the Vulkan devices and what each lacks.", "vkpm devices [--json]");
    parser.flag("--json", "as JSON", options.json);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    return options;
}

Options parseBench(std::span<const std::string> arguments) {
    BenchOptions options;
    Parser parser("Measure rays, sort, gather and memory rates; or what a program compiled for a scene saves.",
                  "vkpm bench [options], vkpm bench --features SCENE.json...");
    parser.flag("--json", "as JSON", options.json);
    parser.add("--scene", "FILE", "scene to trace rays in (default: one of its own)", options.scene, sceneOf);
    parser.flag("--features", "start-up, time and memory of the program for each scene against the general one's",
                options.features);
    parser.files("scenes for --features", [&](auto& values) {
        if (options.features && values.empty())
            throw InputError(
                "bench: --features: found no scene; allowed: one or more, as in vkpm bench --features scenes/box.json");
        if (!options.features && !values.empty())
            throw InputError(fmt::format("bench: found \"{}\"; allowed: --scene {}", values[0], values[0]));
        for (const std::string& value : values) options.scenes.push_back(valueOf("--features", value, sceneOf));
    });
    addDevice(parser, options.device);
    if (const std::string text = parser.parse(arguments); !text.empty()) return PrintOptions{text};
    return options;
}

const std::pair<const char*, Options (*)(std::span<const std::string>)> PARSERS[]{
    {"render", parseRender<RenderOptions>},
    {"view", parseRender<ViewOptions>},
    {"plan", parsePlan},
    {"compare", parseCompare},
    {"merge", parseMerge},
    {"devices", parseDevices},
    {"bench", parseBench}};

} // namespace

static Options parseCommand(const std::vector<std::string>& words) {
    if (words[0].starts_with('-')) return parseRender<RenderOptions>(words);
    std::vector<std::string> known;
    for (const auto& [name, parse] : PARSERS) {
        if (words[0] == name) return parse(std::span(words).subspan(1));
        known.push_back(name);
    }
    const std::string help =
        fs::path(words[0]).has_extension() ? "; a scene is given as --scene " + words[0] : suggestion(words[0], known);
    throw InputError(fmt::format("found command \"{}\"; allowed: {}{}", words[0], fmt::join(known, ", "), help));
}

Options parseOptions(int count, const char* const* arguments) {
    std::vector<std::string> words(arguments + std::min(count, 1), arguments + count);
    if (words.empty()) words.push_back("--help");
    const Options options = parseCommand(words);
    const auto* print = std::get_if<PrintOptions>(&options);
    return print && print->text == versionText ? Options(VersionOptions{}) : options;
}

} // namespace vkpm
