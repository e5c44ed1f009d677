/// vkpm bench: how fast rays, sorting, gathers and memory are, each beside a yardstick measured in the same run.
#include "bench/bench_scene.h"
#include "bench/features.h"
#include "bench/gather.h"
#include "bench/memory.h"
#include "bench/rays.h"
#include "commands/commands.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace vkpm {

/// Names of measurements end in that of their scene.
static std::vector<Measurement> raysOf(Gpu& gpu, const Scene& scene, const std::string& name) {
    std::vector<Measurement> all = measureRays(gpu, scene);
    for (Measurement& m : all) m.name += name;
    return all;
}

static std::vector<Measurement> measureAll(Gpu& gpu, const Scene& scene, bool own) {
    std::vector<Measurement> all = raysOf(gpu, scene, "");
    if (own) {
        for (Measurement& m : raysOf(gpu, benchScene(0, 0), "_box")) all.push_back(std::move(m));
        for (Measurement& m : raysOf(gpu, benchScene(1024, 512), "_million")) all.push_back(std::move(m));
    }
    all.push_back(measureSort(gpu));
    all.push_back(measureGather(gpu, scene));
    for (Measurement& copy : measureCopies(gpu)) all.push_back(std::move(copy));
    return all;
}

static void printJson(const nlohmann::ordered_json& about, const std::vector<Measurement>& all) {
    nlohmann::ordered_json object = about;
    for (const Measurement& m : all)
        object[m.name] = {
            {"vkpm", m.vkpm}, {"yardstick", m.yardstick}, {"ratio", m.ratio}, {"unit", m.unit}, {"against", m.against}};
    fmt::print("{}\n", object.dump(2));
}

// A number with three digits and the prefix of its unit.
static std::string quantity(double value, const std::string& unit) {
    if (value >= 1e9) return fmt::format("{:.2f} G{}", value * 1e-9, unit);
    if (value >= 1e6) return fmt::format("{:.2f} M{}", value * 1e-6, unit);
    return fmt::format("{:.2f} {}", value, unit);
}

static void printTable(const nlohmann::ordered_json& about, const std::vector<Measurement>& all) {
    for (const auto& [key, value] : about.items())
        fmt::print("{:<10} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    fmt::print("\n{:<20} {:>15} {:>15} {:>7}  {}\n", "", "vkpm", "yardstick", "ratio", "yardstick is");
    for (const Measurement& m : all)
        fmt::print("{:<20} {:>15} {:>15} {:>7.3f}  {}\n", m.name, quantity(m.vkpm, m.unit),
                   quantity(m.yardstick, m.unit), m.ratio, m.against);
    fmt::print("\nMedians of warm runs in pairs; ratio is vkpm over yardstick (of ms, less is better).\n"
               "vkpm by the kernels' time stamps, yardsticks by the wall clock, on all threads.\n");
}

static nlohmann::ordered_json gainJson(const FeatureGain& gain) {
    const auto json = [](const ProgramCost& c) {
        return nlohmann::ordered_json{{"setup_seconds", c.setup},
                                      {"first_pass_seconds", c.firstPass},
                                      {"pass_seconds", c.pass},
                                      {"device_bytes", c.bytes}};
    };
    return {{"scene", gain.scene}, {"specialised", json(gain.special)}, {"general", json(gain.general)}};
}

static void printGain(const FeatureGain& gain) {
    const auto row = [&](const char* what, double special, double general, const char* unit) {
        fmt::print("{:<14} {:<24} {:>9.3f} {:>9.3f} {:<4} {:>7.2f}\n", gain.scene, what, special, general, unit,
                   special / general);
    };
    row("setup", gain.special.setup, gain.general.setup, "s");
    row("setup and first pass", gain.special.firstPass, gain.general.firstPass, "s");
    row("a later pass", gain.special.pass, gain.general.pass, "s");
    row("device memory", gain.special.bytes / 1048576, gain.general.bytes / 1048576, "MiB");
}

static int benchFeatures(const BenchOptions& options) {
    switchOffShaderCaches();
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    if (!options.json)
        fmt::print("{:<14} {:<24} {:>9} {:>9} {:<4} {:>7}\n", "scene", "", "special", "general", "", "ratio");
    for (const auto& scene : options.scenes) {
        const FeatureGain gain = measureFeatures(scene, options.device);
        if (!options.json) printGain(gain);
        all.push_back(gainJson(gain));
    }
    if (options.json) fmt::print("{}\n", all.dump(2));
    else fmt::print("\nMedians of runs in turns, all kernels compiled anew in each, at the scenes' own settings.\n");
    return 0;
}

int execute(const BenchOptions& options) {
    if (options.features) return benchFeatures(options);
    const Scene scene = options.scene.empty() ? benchScene(256, 64) : loadScene(options.scene);
    Gpu gpu(options.device);
    gpu.timesKernels = true;
    const nlohmann::ordered_json about{{"device", gpu.info().name},
                                       {"driver", gpu.info().driver},
                                       {"threads", std::thread::hardware_concurrency()},
                                       {"scene", scene.name},
                                       {"triangles", scene.triangleCount},
                                       {"spheres", scene.primitives.size() - scene.triangleCount}};
    const std::vector<Measurement> all = measureAll(gpu, scene, options.scene.empty());
    if (options.json) printJson(about, all);
    else printTable(about, all);
    return 0;
}

} // namespace vkpm
