/// How a scene is rendered: defaults, overridden first by the scene file, then by the command line.
#pragma once
#include "shared.h"
#include <optional>

namespace vkpm {

struct Settings {
    uvec2 size{512, 512};                // pixels
    uint passes = 16;                    //
    uint photons = 200'000;              // emitted into the global map per pass
    uint causticPhotons = 100'000;       // aimed at specular shapes per pass
    std::optional<float> radius;         // of the first global gather, world units; measured if absent
    std::optional<float> causticRadius;  // likewise of the caustic gather, by region
    uint nearest = 0;                    // first radius: that of the k nearest photons, `radius` at most; 0: not so
    float alpha = 2.0f / 3;              // how fast radii shrink from pass to pass; 1: not at all
    uint kernel = KERNEL_CONSTANT;       // KERNEL_...
    bool schlick = false;                // Schlick's Fresnel in place of the exact one
    uint seed = 0;                       //
    uint integrator = INTEGRATOR_PHOTON; // INTEGRATOR_...
    bool showCaustic = false;            // photon-map: the caustic map in place of the global one
    bool showPoints = false;             // photon-map: photons as points in place of the estimate
    bool allFeatures = false;            // the general program in place of one compiled for the scene; the same picture
    float exposure = 0;                  // stops, for the PNG alone
};

} // namespace vkpm
