/// Faces of glass that lie on each other.
#pragma once
#include "scene/scene.h"
#include <vector>

namespace vkpm {

/// For each triangle, which triangles of other shapes of glass may lie on it but for rounding, as
/// DeviceScene::touching has it; empty if there are none. Glass that says by hand what is outside takes no part; if it
/// lies on other glass, there is a warning.
std::vector<uint> touchingTriangles(Scene& scene, const std::filesystem::path& file);

} // namespace vkpm
