/// What leaving out buys: a program compiled for a scene against the general one.
#pragma once
#include <filesystem>
#include <string>

namespace vkpm {

/// Medians of runs that take turns.
struct ProgramCost {
    double firstPass = 0; // seconds from nothing to the end of the first pass: scene, device, compiling, pilot, pass
    double setup = 0;     // that without the pass itself
    double pass = 0;      // seconds of a later pass
    double bytes = 0;     // device memory at most
};

struct FeatureGain {
    std::string scene;
    ProgramCost special;
    ProgramCost general;
};

/// Renders some passes with each program, in turns, with the driver's shader cache off; before any device is opened.
FeatureGain measureFeatures(const std::filesystem::path& scene, const std::string& device);

/// Switches off the shader caches of Mesa and of NVIDIA's driver for this process.
void switchOffShaderCaches();

} // namespace vkpm
