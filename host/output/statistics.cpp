/// What a render did and what it took, as one JSON object.
#include "output/statistics.h"
#include "output/atomic_file.h"
#include "shared_kinds.h"
#include <nlohmann/json.hpp>

namespace vkpm {
namespace {

using Json = nlohmann::ordered_json;

/// An object of names and the sums of their values, in the order of first occurrence.
template <class Value> Json sums(const std::vector<std::pair<std::string, Value>>& entries) {
    Json object = Json::object();
    for (const auto& [name, value] : entries) object[name] = object.value(name, Value{}) + value;
    return object;
}

Json photonsJson(const PhotonLedger& counts) {
    return {{"emitted", counts.emitted},
            {"stored", counts.stored},
            {"absorbed", counts.absorbed},
            {"escaped", counts.escaped},
            {"lost", counts.lost}};
}

/// By the names that `vkpm plan` has; kinds of materials and lights have one each.
Json featuresJson(const Features& features) {
    Json object = Json::object();
#define X(id, type, name, value) object[#name] = uint(features.name);
    FEATURES(X)
#undef X
#define X(id, NAME, name, lobes, words) object["has" #name] = features.materialKinds >> id & 1;
    MATERIALS(X)
#undef X
#define X(id, NAME, name, words) object["has" #name "Lights"] = features.lightKinds >> id & 1;
    LIGHTS(X)
#undef X
    object.erase("materialKinds");
    object.erase("lightKinds");
    return object;
}

} // namespace

Json radiiJson(const std::optional<GatherRadii>& radii) {
    if (!radii) return nullptr;
    return {{"smallest", radii->smallest},
            {"typical", radii->typical},
            {"greatest", radii->greatest},
            {"chosen_by", radii->given ? "user" : "program"}};
}

std::string statisticsJson(const Statistics& statistics) {
    Json object;
    object["device"] = statistics.device;
    object["seed"] = statistics.seed;
    object["passes"] = statistics.passes;
    object["seconds"] = {
        {"total", statistics.totalSeconds}, {"setup", statistics.setupSeconds}, {"render", statistics.renderSeconds}};
    object["stages"] = sums(statistics.stages);
    object["rays"] = statistics.rays;
    object["waits"] = statistics.waits;
    object["dispatches"] = statistics.dispatches;
    object["photons"] = {{"global", photonsJson(statistics.global)}, {"caustic", photonsJson(statistics.caustic)}};
    object["radius"] = {{"global", radiiJson(statistics.globalRadii)},
                        {"caustic", radiiJson(statistics.causticRadii)},
                        {"factor", statistics.radiusFactor}};
    object["memory"] = {{"device_bytes", statistics.deviceBytes}, {"buffers", sums(statistics.buffers)}};
    object["features"] = featuresJson(statistics.features);
    object["needed"] = statistics.needed;
    object["left_out"] = statistics.leftOut;
    object["error"] = nullptr;
    if (const auto& e = statistics.error)
        object["error"] = {{"relative", e->error},   {"noise", e->noise},
                           {"bias", e->bias},        {"confidence", 0.9},
                           {"kept", KEPT},           {"specks", e->specks},
                           {"all_pixels", e->whole}, {"quantile", intervalQuantile(statistics.noiseFreedom)}};
    object["nonfinite"] = statistics.nonfinite;
    object["warnings"] = statistics.warnings;
    return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeStatistics(const std::filesystem::path& path, const Statistics& statistics) {
    replaceFile(path, statisticsJson(statistics));
}

} // namespace vkpm
