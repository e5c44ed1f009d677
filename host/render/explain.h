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

} // namespace vkpm
