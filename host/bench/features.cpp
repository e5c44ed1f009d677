/// Whole renders, timed from the scene file on.
#include "bench/features.h"
#include "bench/measure.h"
#include "gpu/audit.h"
#include "render/renderer.h"
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

namespace vkpm {
namespace {

constexpr int turns = 5;
constexpr uint passes = 5;

ProgramCost renderOnce(const std::filesystem::path& file, const std::string& device, bool allFeatures) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const Scene scene = loadScene(file);
    Settings settings = scene.settings;
    settings.allFeatures = allFeatures;
    Gpu gpu(device);
    requireSoundDriver(gpu);
    Renderer renderer(gpu, scene, settings);
    ProgramCost cost;
    cost.setup = seconds();
    std::vector<double> each;
    for (uint pass = 0; pass < passes; pass++) {
        const double before = seconds();
        renderer.renderPass(pass);
        if (pass == 0) cost.firstPass = seconds();
        else each.push_back(seconds() - before);
    }
    cost.pass = median(each);
    cost.bytes = double(gpu.peakBytes);
    return cost;
}

ProgramCost medians(const std::vector<ProgramCost>& costs) {
    const auto of = [&](double ProgramCost::*member) {
        std::vector<double> values;
        for (const ProgramCost& cost : costs) values.push_back(cost.*member);
        return median(values);
    };
    return {of(&ProgramCost::firstPass), of(&ProgramCost::setup), of(&ProgramCost::pass), of(&ProgramCost::bytes)};
}

} // namespace

void switchOffShaderCaches() {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("__GL_SHADER_DISK_CACHE", "0", 1);
}

FeatureGain measureFeatures(const std::filesystem::path& scene, const std::string& device) {
    std::vector<ProgramCost> special, general;
    renderOnce(scene, device, false); // loads the driver
    for (int turn = 0; turn < turns; turn++) {
        special.push_back(renderOnce(scene, device, false));
        general.push_back(renderOnce(scene, device, true));
    }
    return {scene.stem().string(), medians(special), medians(general)};
}

} // namespace vkpm
