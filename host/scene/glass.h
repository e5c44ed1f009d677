/// Glass that is not the boundary of a solid, by shape.
#pragma once
#include "scene/scene.h"
#include <string>
#include <vector>

namespace vkpm {

/// Primitives first .. end - 1 of a scene, which are one shape of glass.
struct GlassShape {
    std::size_t first;
    std::size_t end;
    Bounds box{};
};

inline bool isGlass(const Material& material) { return (GLASS_KINDS >> material.kind & 1) != 0; }

/// The box about a shape.
Bounds boxOf(const Scene& scene, const GlassShape& shape);

/// What is wrong with a shape of glass, in words, and what helps: open where nothing else closes it, turned inside out
/// or here and there, or so thin that rounding joins its faces. Light that enters such glass does not leave it as it
/// should. Rectangles may close each other.
std::vector<std::string> wrongWithGlass(const Scene& scene, const GlassShape& shape);

/// Whether a face of one shape lies on a face of another, given their boxes, but for rounding: light that comes there
/// takes one of them alone.
bool touch(const Scene& scene, const GlassShape& one, const GlassShape& other);

/// Whether triangles of glass and of something opaque may be as near to each other as roundings, by their boxes; far
/// lights aside.
bool glassMayTouchOpaque(const Scene& scene);

} // namespace vkpm
