/// Why a scene needs a feature, or does without it.
#pragma once
#include "scene/scene.h"

namespace vkpm {

struct FeatureReason {
    std::string name; // as in FEATURES
    bool needed;
    std::string reason; // "the scene has no glass"
};

/// One line for each feature that may be left out, in the order of FEATURES.
std::vector<FeatureReason> explainFeatures(const Features& features, const Settings& settings);

/// What of a scene's light an integrator cannot find, for a warning; empty if it finds all.
std::string blindness(const Scene& scene, const Settings& settings);

} // namespace vkpm
