/// What a glossy lobe leaves to a diffuse one.
#pragma once
#include "shared_scene.h"
#include <vector>

namespace vkpm {

/// A row of DeviceScene.rests: 1 - E at REST_STEPS + 1 cosines and its mean, where E is the albedo of a single
/// reflection by GGX of width alpha and Schlick's reflectance of `normalIncidence` (1: all).
std::vector<float> restRow(double alpha, double normalIncidence);

/// The number of the first of some rows within `rests`, to which they are added unless they are there.
uint placeRows(std::vector<float>& rests, const std::vector<float>& rows);

/// The rows of a standard material: for reflectances of 0 and of 1 at normal incidence.
std::vector<float> standardRows(double alpha);

} // namespace vkpm
