/// What surfaces emit where a texture says it.
#pragma once
#include "scene/scene.h"

namespace vkpm {

/// A part of a texture that a light shows: coordinates at a corner, and along both sides of it. Spheres show all.
struct EmissionPart {
    const TextureArrays& arrays;
    const Texture& texture;
    glm::dvec2 corner{0}, u{1, 0}, v{0, 1};
    uint kind = LIGHT_RECTANGLE;
};

/// The mean of what a light emits over its area, as probabilities need it: near the exact one, and 0 only if the light
/// is black everywhere.
glm::dvec3 meanEmission(const EmissionPart& part);

/// Into how many parts along either side a rectangle is best cut, each a light of its own, since some of its places are
/// much brighter than others.
glm::uvec2 partsOf(const EmissionPart& rectangle);

} // namespace vkpm
