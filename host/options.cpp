/// The command line.
#include "options.h"
#include "option_parser.h"
#include "output/layer_error.h"
#include "output/report.h"
#include "output/used_files.h"
#include <array>

namespace vkpm {
namespace {

const Words INTEGRATORS{{"photon", INTEGRATOR_PHOTON},
                        {"path", INTEGRATOR_PATH},
                        {"direct", INTEGRATOR_DIRECT},
                        {"photon-map", INTEGRATOR_PHOTON_MAP},
                        {"light", INTEGRATOR_LIGHT}};
const Words MAPS{{"global", 0}, {"caustic", 1}};
const Words SHOWS{{"estimate", 0}, {"points", 1}};
const Words KERNELS{{"constant", KERNEL_CONSTANT},
                    {"cone", KERNEL_CONE},
                    {"gauss", KERNEL_GAUSS},
                    {"epanechnikov", KERNEL_EPANECHNIKOV}};
const Words PROGRAMS{{"scene", 0}, {"all", 1}};
const Words FRESNELS{{"exact", 0}, {"schlick", 1}};

void addDevice(Parser& parser, Options& options) {
    parser.add("--device", "INDEX|NAME", "Vulkan device by number or part of its name (default: the best)",
               [&](auto&, auto& value) { options.device = value; });
}

void addMachine(Parser& parser, Options& options) {
    parser.words("--features", PROGRAMS, "compile kernels for this scene, or with everything switched on (default scene)",
                 [&](uint value) { options.allFeatures = value; });
    addDevice(parser, options);
}

void addFiles(Parser& parser, Options& options) {
    parser.group("Files");
    parser.add("--scene", "FILE", "scene to render (JSON); required",
               [&](auto& name, auto& value) { options.scene = sceneOf(name, value); });
    parser.add("-o,--output", "FILE.exr", "image; a PNG is written beside it (default: the scene's name, here)",
               [&](auto& name, auto& value) { options.output = exrOf(name, value); });
    parser.add("--stats", "FILE.json", "what the render did: seconds, rays, photons, memory",
               [&](auto& name, auto& value) { options.stats = outputOf(name, value); });
    parser.add("--report", "FOLDER", "error against run time while rendering: error.csv, and a page index.html",
               [&](auto&, auto& value) { options.report = value; });
    parser.add("--reference", "FILE.exr", "what --report measures the error against; without it, the render's own estimates",
               [&](auto&, auto& value) { options.reference = value; });
    parser.add("--log", "FILE.jsonl", "what happens and when, a JSON object per line",
               [&](auto& name, auto& value) { options.log = outputOf(name, value); });
    parser.flag("--resume", "go on from what --output holds, if it is there", options.resume);
    parser.flag("--no-resume", "save the picture and its layers alone, in half the bytes, without the sums from which --resume and merge go on", options.withoutSums);
    parser.flag("--half", "save layers, but for depth, as 16-bit floats", options.half);
    parser.add("--checkpoint", "SECONDS", "save every so often (default: only at the end)",
               [&](auto& name, auto& value) { options.checkpoint = secondsOf(name, value); });
}

void addImage(Parser& parser, Options& options, const Settings& defaults, const std::string& passes) {
    const auto count = [&](const std::string& name, const std::string& help, uint low, uint high, auto& target) {
        parser.add(name, "N", help,
                   [=, &target](auto& option, auto& text) { target = countOf(option, text, low, high); });
    };
    parser.group("Image (overrides the scene file, which overrides the defaults)");
    parser.add("--size", "WxH", fmt::format("pixels (default {}x{})", defaults.size.x, defaults.size.y),
               [&](auto& name, auto& value) { options.size = sizeOf(name, value); });
    count("--passes", fmt::format("passes over the whole image (default {})", passes), 1, MAX_COUNT, options.passes);
    parser.add("--time", "SECONDS", "of rendering, to the nearest pass; ends at --passes if that is given and comes first",
               [&](auto& name, auto& value) { options.seconds = secondsOf(name, value); });
    parser.add("--target-error", "E", "relative error, such as 0.01 or 1%, 90 % sure; ends there, or at --passes or --time if given",
               [&](auto& name, auto& value) { options.targetError = errorOf(name, value); });
    parser.add("--pass-range", "A:B", "render only the passes A to B-1, a part for vkpm merge",
               [&](auto& name, auto& value) { options.passRange = passRangeOf(name, value); });
    count("--seed", fmt::format("seed of the random numbers (default {})", defaults.seed), 0, NONE, options.seed);
    parser.words("--integrator", INTEGRATORS,
                 fmt::format("how light is found (default {})", wordOf(INTEGRATORS, defaults.integrator)),
                 [&](uint value) { options.integrator = value; });
    parser.words("--map", MAPS, fmt::format("photon-map: which map (default {})", wordOf(MAPS, defaults.showCaustic)),
                 [&](uint value) { options.showCaustic = value; });
    parser.words("--show", SHOWS, fmt::format("photon-map: as what (default {})", wordOf(SHOWS, defaults.showPoints)),
                 [&](uint value) { options.showPoints = value; });
    parser.words("--fresnel", FRESNELS,
                 fmt::format("reflectance of glass (default {})", wordOf(FRESNELS, defaults.schlick)),
                 [&](uint value) { options.schlick = value; });
    parser.add("--layers", "A,B,...", fmt::format("render only these; beauty is the sum of the lights' parts among them: {} (default all)", fmt::join(layerNames, ", ")),
               [&](auto& name, auto& value) { options.layers = layersOf(name, value); });
}

void addPhotons(Parser& parser, Options& options, const Settings& defaults) {
    const auto count = [&](const std::string& name, const std::string& help, auto& target) {
        parser.add(name, "N", help, [&](auto& option, auto& text) { target = countOf(option, text, 0, MAX_COUNT); });
    };
    const auto radius = [&](const std::string& name, const std::string& help, auto& target) {
        parser.add(name, "R", help, [&](auto& option, auto& text) { target = radiusOf(option, text); });
    };
    parser.group("Photons (likewise)");
    count("--photons", fmt::format("emitted per pass (default {})", defaults.photons), options.photons);
    count("--caustic-photons", fmt::format("aimed at specular shapes per pass (default {})", defaults.causticPhotons),
          options.causticPhotons);
    parser.add("--gather-rays", "N", fmt::format("from each point that the eye sees, per pass, 1 to {} (default {})", mostGatherRays, defaults.gatherRays),
               [&](auto& name, auto& value) { options.gatherRays = countOf(name, value, 1, mostGatherRays); });
    radius("--radius", "first gather radius, world units (default: measured by a pilot pass)", options.radius);
    radius("--caustic-radius", "the same for caustics", options.causticRadius);
    count("--nearest", fmt::format("first radius: that of the N nearest; 0: one for all (default {})", defaults.nearest),
          options.nearest);
    parser.add("--alpha", "A", fmt::format("how fast radii shrink from pass to pass; 1: not at all (default {:.3})", defaults.alpha),
               [&](auto& name, auto& value) { options.alpha = alphaOf(name, value); });
    parser.words("--kernel", KERNELS,
                 fmt::format("of the density estimate (default {})", wordOf(KERNELS, defaults.kernel)),
                 [&](uint value) { options.kernel = value; });
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

/// Refuses --map and --show with an integrator that shows no photon map.
void requirePhotonMap(const Options& options, uint integrator) {
    if (integrator == INTEGRATOR_PHOTON_MAP) return;
    for (const auto& [name, given] : {std::pair("--map", options.showCaustic), std::pair("--show", options.showPoints)})
        if (given)
            throw InputError(fmt::format("{}: found with --integrator {}; allowed: only with --integrator photon-map",
                                         name, wordOf(INTEGRATORS, integrator)));
}

void requireRender(Options& options) {
    if (options.scene.empty()) throw InputError(fmt::format("--scene: missing; allowed: a scene file, as in vkpm{} --scene FILE", options.command == Command::View ? " view" : ""));
    if (options.output.empty()) options.output = exrOf("--output", options.scene.stem().string() + ".exr");
    requireFilesApart(options, std::array{options.scene});
    if (options.passRange && options.passes && options.passRange->end > *options.passes)
        refuse("--pass-range", fmt::format("{}:{}", options.passRange->begin, options.passRange->end),
               fmt::format("passes below the {} of --passes", *options.passes));
    if (options.reference && !options.report) refuse("--reference", options.reference->string(), "only with --report FOLDER, which shows what is measured");
    if (options.integrator) requirePhotonMap(options, *options.integrator);
    const auto needsSums = [&](const char* name, bool given) {
        if (given && options.withoutSums) throw InputError(fmt::format("{}: found with --no-resume; allowed: one of the two, since it needs the sums that --no-resume leaves out", name));
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
Options parseRender(std::span<const std::string> arguments, Command command) {
    Options options;
    const bool window = command == Command::View;
    Parser parser(window ? "Render a scene in a window, progressively." : "vkpm, a photon mapping renderer in Vulkan compute.",
                  window ? "vkpm view --scene FILE [options]" : "vkpm [render] --scene FILE [options]");
    const Settings defaults;
    addFiles(parser, options);
    addImage(parser, options, defaults, window ? "no end" : std::to_string(defaults.passes));
    addPhotons(parser, options, defaults);
    parser.group("Machine");
    addMachine(parser, options);
    parser.flag("--quiet", "no progress on stderr", options.quiet);
    parser.footer(window ? WINDOW : COMMANDS);
    options.text = parser.parse(arguments);
    if (!options.text.empty()) return options;
    options.command = command;
    requireRender(options);
    return options;
}

Options parsePlan(std::span<const std::string> arguments) {
    Options options;
    const Settings defaults;
    Parser parser("Say what a scene needs, what is left out and why, and how much memory it takes. Renders one pass.",
                  "vkpm plan --scene FILE [options]");
    parser.add("--scene", "FILE", "scene (JSON); required", [&](auto& name, auto& value) { options.scene = sceneOf(name, value); });
    parser.flag("--json", "as JSON", options.json);
    addImage(parser, options, defaults, std::to_string(defaults.passes));
    addPhotons(parser, options, defaults);
    parser.group("Machine");
    addMachine(parser, options);
    options.text = parser.parse(arguments);
    if (!options.text.empty()) return options;
    if (options.scene.empty()) throw InputError("--scene: missing; allowed: a scene file, as in vkpm plan --scene FILE");
    options.command = Command::Plan;
    return options;
}

Options parseCompare(std::span<const std::string> arguments) {
    Options options;
    Parser parser("Measure how far an image is off a reference, layer by layer. Needs no device.", "vkpm compare IMAGE REFERENCE [--json]");
    parser.files("files", "the image, then its reference (EXR)", [&](auto& values) {
        if (values.size() != 2)
            throw InputError(fmt::format("compare: found {} file{}; allowed: two, as in vkpm compare IMAGE REFERENCE", values.size(), values.size() == 1 ? "" : "s"));
        options.parts.assign(values.begin(), values.end());
    });
    parser.flag("--json", "as JSON, with null for what cannot be said", options.json);
    parser.footer(MEASURES);
    options.text = parser.parse(arguments);
    if (options.text.empty()) options.command = Command::Compare;
    return options;
}

Options parseMerge(std::span<const std::string> arguments) {
    Options options;
    Parser parser("Put parts of one render, made with --pass-range, together.", "vkpm merge OUT.exr PART.exr... [options]");
    parser.files("files", "the merged image, then its parts in any order", [&](auto& values) {
        if (values.size() < 2) throw InputError("merge: found fewer than two files; allowed: vkpm merge OUT.exr PART.exr...");
        options.output = exrOf("OUT.exr", values[0]);
        options.parts.assign(values.begin() + 1, values.end());
    });
    parser.flag("--part", "allow a result that does not begin with pass 0", options.part);
    addDevice(parser, options);
    options.text = parser.parse(arguments);
    if (options.text.empty()) options.command = Command::Merge;
    return options;
}

Options parseDevices(std::span<const std::string> arguments) {
    Options options;
    Parser parser("List the Vulkan devices and what each lacks.", "vkpm devices [--json]");
    parser.flag("--json", "as JSON", options.json);
    options.text = parser.parse(arguments);
    if (options.text.empty()) options.command = Command::Devices;
    return options;
}

Options parseBench(std::span<const std::string> arguments) {
    Options options;
    Parser parser("Measure rays, sort, gather and memory rates; or what a program compiled for a scene saves.",
                  "vkpm bench [options], vkpm bench --features SCENE.json...");
    parser.flag("--json", "as JSON", options.json);
    parser.add("--scene", "FILE", "scene to trace rays in (default: one of its own)",
               [&](auto& name, auto& value) { options.scene = sceneOf(name, value); });
    parser.flag("--features", "start-up, time and memory of the program for each scene against the general one's", options.benchFeatures);
    parser.files("files", "scenes for --features", [&](auto& values) {
        if (options.benchFeatures && values.empty()) throw InputError("bench: --features: found no scene; allowed: one or more, as in vkpm bench --features scenes/box.json");
        if (!options.benchFeatures && !values.empty()) throw InputError(fmt::format("bench: found \"{}\"; allowed: --scene {}", values[0], values[0]));
        for (const std::string& value : values) options.parts.push_back(sceneOf("--features", value));
    });
    addDevice(parser, options);
    options.text = parser.parse(arguments);
    if (options.text.empty()) options.command = Command::Bench;
    return options;
}

Options parseCommand(std::span<const std::string> all) {
    if (all[0].starts_with('-') || all[0] == "render") return parseRender(all.subspan(all[0] == "render"), Command::Render);
    if (all[0] == "view") return parseRender(all.subspan(1), Command::View);
    if (all[0] == "plan") return parsePlan(all.subspan(1));
    if (all[0] == "compare") return parseCompare(all.subspan(1));
    if (all[0] == "merge") return parseMerge(all.subspan(1));
    if (all[0] == "devices") return parseDevices(all.subspan(1));
    if (all[0] == "bench") return parseBench(all.subspan(1));
    const bool isFile = fs::path(all[0]).has_extension();
    throw InputError(fmt::format("found command \"{}\"; allowed: render, view, plan, compare, merge, devices, bench{}", all[0],
                                 isFile ? "; a scene is given as --scene " + all[0]
                                        : suggestion(all[0], {"render", "view", "plan", "compare", "merge", "devices", "bench"})));
}

} // namespace

Settings Options::override(Settings settings) const {
    const auto set = [](auto& target, const auto& value) { if (value) target = *value; };
    set(settings.size, size);
    set(settings.integrator, integrator);
    set(settings.showCaustic, showCaustic);
    set(settings.showPoints, showPoints);
    set(settings.passes, passes);
    set(settings.photons, photons);
    set(settings.causticPhotons, causticPhotons);
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
    if (targetError && (settings.layers & (1u << ASK_NOISE | 1u << ASK_BIAS)) != (1u << ASK_NOISE | 1u << ASK_BIAS))
        throw InputError("--target-error: needs the layers noise and bias; allowed: with all layers, or with both in --layers");
    return settings;
}

fs::path pngBeside(fs::path exr) { return exr.replace_extension(".png"); }

void requireFilesApart(const Options& options, std::span<const fs::path> sceneFiles) {
    std::vector<UsedFile> written{{"--output", options.output}, {"--output's PNG", pngBeside(options.output)}}, read;
    if (options.stats) written.push_back({"--stats", *options.stats});
    if (options.log) written.push_back({"--log", *options.log});
    if (options.report)
        for (const char* name : Report::files) written.push_back({"--report", *options.report / name});
    for (const fs::path& file : sceneFiles) read.push_back({file == sceneFiles[0] ? "the scene" : "a mesh of the scene", file});
    if (options.reference) read.push_back({"--reference", *options.reference});
    requireApart(written, read);
}

Options parseOptions(int count, const char* const* arguments) {
    std::vector<std::string> words(arguments + std::min(count, 1), arguments + count);
    if (words.empty()) words.push_back("--help");
    Options options = parseCommand(words);
    if (options.text == versionText) options.command = Command::Version;
    return options;
}

} // namespace vkpm
