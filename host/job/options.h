/// What a command asks of a render.
#pragma once
#include "scene/settings.h"
#include "shared_film.h"
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace vkpm {

/// What is put over a scene's settings; absent: as the scene says.
struct SettingsOptions {
    std::optional<uvec2> size;
    std::optional<uint> integrator;
    std::optional<bool> showCaustic;
    std::optional<bool> showPoints;
    std::optional<uint> passes;
    std::optional<uint> photons;
    std::optional<uint> pixelSamples;
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

    bool operator==(const SettingsOptions&) const = default;

    /// A scene's settings with these over them. Throws InputError if --map or --show meets an integrator other than
    /// photon-map.
    Settings over(Settings sceneSettings) const;
};

/// A render: its scene and files, and when it ends.
struct RenderOptions : SettingsOptions {
    std::filesystem::path scene;
    std::filesystem::path output; // always set, ends in .exr
    std::optional<std::filesystem::path> stats;
    std::optional<std::filesystem::path> log;
    std::optional<std::filesystem::path> reference;
    std::optional<std::filesystem::path> report; // folder
    bool resume = false;
    bool withoutSums = false;          // --no-resume: the picture alone
    bool labels = false;               // of paths, in place of the albedo
    bool half = false;                 // layers as 16-bit floats
    std::optional<double> checkpoint;  // seconds between saves
    std::optional<double> seconds;     // of rendering
    std::optional<double> targetError; // relative, to stop at
    std::optional<PassRange> passRange;
    bool isEndless = false; // in a window: it goes on until it is closed, unless an end is given
    std::string device;     // index or part of the name; empty: vkpm chooses
    bool quiet = false;

    /// As `over`; throws InputError also if --target-error lacks the layers that it needs.
    Settings settingsOf(const Settings& sceneSettings) const;
};

/// Throws InputError if --map or --show is given with an integrator that shows no photon map.
void requirePhotonMap(const SettingsOptions& options, uint integrator);

/// Throws InputError if an output of a render is one of its inputs, `sceneFiles` among them, or another output.
void requireFilesApart(const RenderOptions& options, std::span<const std::filesystem::path> sceneFiles);

/// The PNG that is written beside an EXR file.
std::filesystem::path pngBeside(std::filesystem::path exr);

} // namespace vkpm
