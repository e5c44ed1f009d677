/// What a render did and what it took, as one JSON object.
#pragma once
#include "render/error_estimate.h"
#include "render/photon_tracing.h"
#include "shared.h"
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vkpm {

/// First gather radii of one map, world units: the same everywhere, or by region.
struct GatherRadii {
    float smallest = 0;
    float typical = 0; // of most photons
    float greatest = 0;
    bool given = false; // by scene or command line; else the program chose them
};

struct Statistics {
    std::string device;
    uint seed = 0;
    uint passes = 0;
    double totalSeconds = 0;                              // wall clock of the program
    double setupSeconds = 0;                              // until the first pass
    double renderSeconds = 0;                             // all passes
    std::vector<std::pair<std::string, double>> stages{}; // seconds; a name that occurs twice is summed
    std::uint64_t rays = 0;                               // of every kind, over all passes
    std::uint64_t waits = 0;                              // of the host for the device, in all passes
    std::uint64_t dispatches = 0;                         // in all passes
    PhotonLedger global{};
    PhotonLedger caustic{};
    std::optional<GatherRadii> globalRadii{}; // absent with the map
    std::optional<GatherRadii> causticRadii{};
    float radiusFactor = 1; // of the last pass: its radii over those of the first
    std::uint64_t deviceBytes = 0;
    std::vector<std::pair<std::string, std::uint64_t>> buffers{}; // bytes; a name that occurs twice is summed
    Features features{};
    std::vector<std::string> needed{};  // what the render has, and why
    std::vector<std::string> leftOut{}; // what it does without, and why
    std::optional<ErrorEstimate> error{};
    uint noiseFreedom = 0;       // degrees, of the noise of pixels
    std::uint64_t nonfinite = 0; // samples that count as black
    std::vector<std::string> warnings{};
};

/// The radii as a JSON object; null if absent.
nlohmann::ordered_json radiiJson(const std::optional<GatherRadii>& radii);

/// The text of the JSON object.
std::string statisticsJson(const Statistics& statistics);

/// Writes it, replacing the file as a whole. Throws std::runtime_error with file and cause.
void writeStatistics(const std::filesystem::path& path, const Statistics& statistics);

} // namespace vkpm
