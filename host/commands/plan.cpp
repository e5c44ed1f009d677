/// vkpm plan: what a scene needs, what is left out and why, kernels' sizes, and memory by buffer.
#include "commands/commands.h"
#include "gpu/audit.h"
#include "gpu/specialization.h"
#include "gpu/spirv.h"
#include "job/memory_advice.h"
#include "render/explain.h"
#include "render/renderer.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

namespace vkpm {

using Json = nlohmann::ordered_json;

static Json featuresJson(const Features& features, const Settings& settings) {
    Json list = Json::array();
    for (const FeatureReason& line : explainFeatures(features, settings))
        list.push_back({{"name", line.name}, {"needed", line.needed}, {"reason", line.reason}});
    return list;
}

/// Kernels' sizes, counted side by side: the optimiser takes seconds for the large ones.
static Json kernelsJson(const Gpu& gpu, const Features& features) {
    std::vector<std::string> names;
    for (const auto& [name, time] : gpu.times)
        if (isKernel(name)) names.push_back(name); // but a copy, or clearing
    std::vector<Json> list(names.size());
    tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
        list[i] = {{"name", names[i]},
                   {"instructions", instructionCount(names[i], features)},
                   {"general_instructions", instructionCount(names[i], Features{})}};
    });
    return list;
}

/// Memory after a pass and a save, and the film's further runs.
static Json memoryJson(const Gpu& gpu, const Features& features, const Settings& settings) {
    const std::uint64_t more = bytesOfFurtherRuns(features, settings);
    Json buffers = Json::object();
    for (const auto& [name, bytes] : gpu.memory)
        if (bytes > 0) buffers[name] = buffers.value(name, std::uint64_t{0}) + bytes + (name == "film" ? more : 0);
    return {{"device_bytes", gpu.peakBytes + more}, {"buffers", buffers}};
}

static void printPlan(const Json& plan) {
    for (const bool needed : {true, false}) {
        fmt::print("{}:\n", needed ? "Needed" : "Left out");
        for (const auto& f : plan["features"])
            if (f["needed"] == needed)
                fmt::print("  {:<20} {}\n", f["name"].get<std::string>(), f["reason"].get<std::string>());
    }
    fmt::print("\nKernels, in SPIR-V instructions for this scene and for any:\n");
    for (const auto& k : plan["kernels"])
        fmt::print("  {:<20} {:6} {:6}\n", k["name"].get<std::string>(), k["instructions"].get<int>(),
                   k["general_instructions"].get<int>());
    fmt::print("\nMemory on the device: {:.1f} MiB at most, by buffer:\n",
               plan["memory"]["device_bytes"].get<double>() / 1048576);
    for (const auto& [name, bytes] : plan["memory"]["buffers"].items())
        fmt::print("  {:<28} {:8.1f} MiB\n", name, bytes.get<double>() / 1048576);
}

int execute(const PlanOptions& options) {
    const Scene scene = loadScene(options.scene);
    const Settings settings = options.settingsOf(scene.settings);
    Gpu gpu(options.device);
    requireSoundDriver(gpu);
    gpu.times.clear(); // of the audit, so that what is left is the scene's
    const Json plan = adviseOnMemory(gpu, scene, settings, [&] {
        Renderer renderer(gpu, scene, settings);
        renderer.renderPass(0);
        return Json{{"scene", scene.name},
                    {"features", featuresJson(renderer.features(), settings)},
                    {"kernels", kernelsJson(gpu, renderer.features())},
                    {"memory", memoryJson(gpu, renderer.features(), settings)}};
    });
    if (options.json) fmt::print("{}\n", plan.dump(2));
    else printPlan(plan);
    return 0;
}

} // namespace vkpm
