/// Writing settings as JSON.
#include "scene/settings_json.h"
#include <nlohmann/json.hpp>

namespace vkpm {

std::string settingsJson(const Settings& s) {
    nlohmann::ordered_json json{{"size", {s.size.x, s.size.y}},
                                {"integrator", integratorNames[s.integrator]},
                                {"photons", s.photons},
                                {"causticPhotons", s.causticPhotons},
                                {"pixelSamples", s.pixelSamples},
                                {"gatherRays", s.gatherRays},
                                {"nearest", s.nearest},
                                {"alpha", s.alpha},
                                {"kernel", kernelNames[s.kernel]},
                                {"fresnel", fresnelNames[s.schlick]},
                                {"seed", s.seed}};
    if (s.layers != allLayers) {
        for (uint i = 0; i < layerNames.size(); i++)
            if (s.layers >> i & 1) json["layers"].push_back(layerNames[i]);
    }
    if (s.labels) json["labels"] = true;
    if (s.radius) json["radius"] = *s.radius;
    if (s.causticRadius) json["causticRadius"] = *s.causticRadius;
    if (s.integrator == INTEGRATOR_PHOTON_MAP) {
        json["map"] = mapNames[s.showCaustic];
        json["show"] = showNames[s.showPoints];
    }
    return json.dump();
}

} // namespace vkpm
