/// Where the coordinates of a scene on the device begin and what they count in, so that 32-bit floats keep their digits
/// and their range.
#pragma once
#include "shared.h"
#include <vector>

namespace vkpm {

/// The coordinates of all shapes and cameras here and on the device.
struct Coordinates {
    glm::dvec3 origin{0}; // in world units
    double unit = 1;      // in world units: a power of two

    glm::dvec3 inside(glm::dvec3 place) const { return (place - origin) / unit; }
    glm::dvec3 world(vec3 place) const { return origin + unit * glm::dvec3{place}; }
    bool operator==(const Coordinates&) const = default;
};

/// Those for a scene with these places, in world units. The origin is near their median, component by component, which
/// one shape of the size of a world does not draw to itself. It is a multiple of a power of two, about as large as the
/// places are spread, so that it is 0 for a scene that stands where its coordinates begin, and taking it away rounds
/// nothing that the scene could see. A scene that is scaled by a power of two, or moved by such a multiple, keeps its
/// bits. The unit is 1 for scenes of usual size; those that are spread over less than 2^-16 or over 2^16 and more count
/// in what they are spread over, or in 2^-40 of their farthest coordinate if that is more: squares and fourth powers of
/// coordinates stay numbers.
Coordinates chooseCoordinates(const std::vector<glm::dvec3>& places);

} // namespace vkpm
