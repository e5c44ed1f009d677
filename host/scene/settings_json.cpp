/// Writing settings as JSON.
#include "scene/settings_json.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vkpm {

std::string settingsJson(const Settings& s) {
    nlohmann::ordered_json json{{"size", {s.size.x, s.size.y}},
                                {"integrator", integratorNames[s.integrator]},
                                {"photons", s.photons},
                                {"causticPhotons", s.causticPhotons},
                                {"gatherRays", s.gatherRays},
                                {"nearest", s.nearest},
                                {"alpha", s.alpha},
                                {"kernel", kernelNames[s.kernel]},
                                {"fresnel", s.schlick ? "schlick" : "exact"},
                                {"seed", s.seed}};
    if (s.layers != allLayers) {
        for (uint i = 0; i < layerNames.size(); i++)
            if (s.layers >> i & 1) json["layers"].push_back(layerNames[i]);
    }
    if (s.radius) json["radius"] = *s.radius;
    if (s.causticRadius) json["causticRadius"] = *s.causticRadius;
    if (s.integrator == INTEGRATOR_PHOTON_MAP) {
        json["map"] = s.showCaustic ? "caustic" : "global";
        json["show"] = s.showPoints ? "points" : "estimate";
    }
    return json.dump();
}

std::string hashText(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

} // namespace vkpm
