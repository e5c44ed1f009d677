/// Where the coordinates of a scene on the device begin: near its shapes, so that 32-bit floats keep their digits.
#pragma once
#include <glm/vec3.hpp>
#include <vector>

namespace vkpm {

/// The origin for a scene with these places, in world units: near their median, component by component, which one shape of
/// the size of a world does not draw to itself. It is a multiple of a power of two, about as large as the places are spread,
/// so that it is 0 for a scene that stands where its coordinates begin, and taking it away rounds nothing that the scene could
/// see. A scene that is scaled by a power of two, or moved by such a multiple, keeps its bits.
glm::dvec3 chooseOrigin(const std::vector<glm::dvec3>& places);

} // namespace vkpm
