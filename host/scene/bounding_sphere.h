/// Small spheres that enclose given points.
#pragma once
#include "shared_scene.h"
#include <span>

namespace vkpm {

/// A sphere that encloses all points, also when distances are computed in float: Ritter's (1990), shrunk and regrown
/// a few times. Not quite the smallest one.
Target boundingSphere(std::span<const vec3> points);

} // namespace vkpm
