/// The command line.
#pragma once
#include "scene/settings.h"
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkpm {

enum class Command { Print, Version, Render, View, Plan, Compare, Merge, Devices, Bench };

/// What the command line asks for; what it leaves open is absent.
struct Options {
    Command command = Command::Print;
    std::string text;             // Print, Version: the help or the first line, for stdout
    std::filesystem::path scene;  // bench: empty for its own scene
    std::filesystem::path output; // render, merge: always set, ends in .exr
    std::vector<std::filesystem::path> parts; // merge; compare: image, reference; bench: scenes
    bool benchFeatures = false;               // bench: what leaving out buys
    bool part = false;                        // merge: into what is a part itself
    std::optional<std::filesystem::path> stats;
    std::optional<std::filesystem::path> log;
    std::optional<std::filesystem::path> reference;
    std::optional<std::filesystem::path> report; // folder
    bool resume = false;
    bool withoutSums = false; // --no-resume: the picture alone
    bool half = false;        // layers as 16-bit floats
    std::optional<double> checkpoint;   // seconds between saves
    std::optional<double> seconds;      // of rendering
    std::optional<double> targetError;  // relative, to stop at
    std::optional<PassRange> passRange;
    std::string device; // index or part of the name; empty: vkpm chooses
    bool json = false;
    bool quiet = false;

    std::optional<uvec2> size;
    std::optional<uint> integrator;
    std::optional<bool> showCaustic;
    std::optional<bool> showPoints;
    std::optional<uint> passes;
    std::optional<uint> photons;
    std::optional<uint> gatherRays;
    std::optional<uint> causticPhotons;
    std::optional<float> radius;
    std::optional<float> causticRadius;
    std::optional<uint> nearest;
    std::optional<float> alpha;
    std::optional<uint> kernel;
    std::optional<bool> schlick;
    std::optional<uint> layers;
    std::optional<uint> seed;
    std::optional<bool> allFeatures;

    /// A scene's settings with the command line's over them. Throws InputError if --map or --show meets an
    /// integrator other than photon-map.
    Settings override(Settings sceneSettings) const;
};

/// Throws InputError if an output of a render is one of its inputs, `sceneFiles` among them, or another output.
void requireFilesApart(const Options& options, std::span<const std::filesystem::path> sceneFiles);

/// The PNG that is written beside an EXR file.
std::filesystem::path pngBeside(std::filesystem::path exr);

/// Reads the command line; main's arguments, the program's name first. Throws InputError with the option, what was
/// found and what is allowed.
Options parseOptions(int count, const char* const* arguments);

} // namespace vkpm
