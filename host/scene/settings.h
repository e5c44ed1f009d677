/// How a scene is rendered: defaults, overridden first by the scene file, then by the command line.
#pragma once
#include "shared.h"
#include <array>
#include <optional>

namespace vkpm {

/// Layers of a picture that may be asked for, bit by bit; the first are those of LAYER_EMISSION and so on.
inline constexpr std::array layerNames{"emission", "direct", "specular", "caustic", "indirect",
                                       "albedo",   "normal", "depth",    "noise",   "bias"};
const uint ASK_ALBEDO = 5, ASK_NORMAL = 6, ASK_DEPTH = 7, ASK_NOISE = 8, ASK_BIAS = 9;
/// Of INTEGRATOR_PHOTON and so on, and of DENSITY_KERNEL_CONSTANT and so on, by number.
inline constexpr std::array integratorNames{"photon", "path", "direct", "photon-map", "light"};
inline constexpr std::array kernelNames{"constant", "cone", "gauss", "epanechnikov"};
/// Of `schlick`, `showCaustic` and `showPoints`.
inline constexpr std::array fresnelNames{"exact", "schlick"};
inline constexpr std::array mapNames{"global", "caustic"};
inline constexpr std::array showNames{"estimate", "points"};
const uint maxGatherRays = 1024;
const uint maxPixelSamples = 256;
const uint maxSide = 65536; // of a picture, in pixels
const uint maxPixels = 1u << 28;
const uint allLayers = (1u << layerNames.size()) - 1;

struct Settings {
    uvec2 size{512, 512};                  // pixels
    uint passes = 16;                      //
    uint photons = 50'000;                 // emitted into the global map per pass
    uint causticPhotons = 50'000;          // aimed at specular shapes per pass
    uint pixelSamples = 5;                 // paths from the eye for each pixel, per pass
    uint gatherRays = 2;                   // from the first diffuse point of the first of them
    std::optional<float> radius;           // of the first global gather, world units; measured if absent
    std::optional<float> causticRadius;    // likewise of the caustic gather, by region
    uint nearest = 0;                      // first radius: that of the k nearest photons, `radius` at most; 0: not so
    float alpha = 2.0f / 3;                // how fast radii shrink from pass to pass; 1: not at all
    uint kernel = DENSITY_KERNEL_CONSTANT; // KERNEL_...
    bool schlick = false;                  // Schlick's Fresnel in place of the exact one
    uint seed = 0;                         //
    uint integrator = INTEGRATOR_PHOTON;   // INTEGRATOR_...
    bool showCaustic = false;              // photon-map: the caustic map in place of the global one
    bool showPoints = false;               // photon-map: photons as points in place of the estimate
    bool guides = true;                    // photons are sent where the eye looks, if many would lie elsewhere
    uint layers = allLayers;               // bits by place in layerNames; what is not asked for is not rendered
    bool labels = false;                   // of the paths that bring pixels most, in place of the albedo
    bool allFeatures = false;  // the general program in place of one compiled for the scene; the same picture
    float exposure = 0;        // stops, for the PNG alone
    bool autoExposure = false; // in its place, by the mean logarithm of the picture
    bool coverage = false;     // the sky is not seen: files say what covers it
};

} // namespace vkpm
