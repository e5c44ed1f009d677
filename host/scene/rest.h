/// What a glossy lobe leaves to a diffuse one.
#pragma once
#include "shared_scene.h"
#include <vector>

namespace vkpm {

/// A row of DeviceScene.rests: 1 - E at REST_STEPS + 1 cosines and its mean, where E is the albedo of a single
/// reflection by GGX of width alpha and Schlick's reflectance of `normalIncidence` (1: all).
std::vector<float> restRow(double alpha, double normalIncidence);

} // namespace vkpm
