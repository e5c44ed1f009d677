/// Glass that is not the boundary of a solid, by shape.
#pragma once
#include "scene/scene.h"
#include <string>
#include <vector>

namespace vkpm {

inline bool isGlass(const Material& material) { return (GLASS_KINDS >> material.kind & 1) != 0; }

/// The box about a shape.
Bounds boxOf(const Scene& scene, const GlassShape& shape);

/// What is wrong with a shape of glass, in words, and what helps: open where nothing else closes it, turned inside out
/// or here and there, or so thin that rounding joins its faces. Light that enters such glass does not leave it as it
/// should. Rectangles may close each other.
std::vector<std::string> wrongWithGlass(const Scene& scene, const GlassShape& shape);

/// Whether triangles of glass and of something opaque may be as near to each other as roundings, by their boxes; far
/// lights aside.
bool glassMayTouchOpaque(const Scene& scene);

} // namespace vkpm
