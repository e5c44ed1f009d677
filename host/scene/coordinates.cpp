/// The choice of an origin and a unit.
#include "scene/coordinates.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

static double median(std::vector<double> xs) {
    const auto middle = xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2);
    std::ranges::nth_element(xs, middle);
    return *middle;
}

/// By the distance over which places are spread, and the farthest of them; what is beyond these limits is refused
/// anyway.
static double chooseUnit(double spread, double reach) {
    const double size = spread > 0 ? std::max(spread, std::ldexp(reach, -40)) : reach;
    return size == 0 || (size >= 0x1p-16 && size < 0x1p16) ? 1 : std::ldexp(1, std::clamp(std::ilogb(size), -31, 41));
}

Coordinates chooseCoordinates(const std::vector<glm::dvec3>& places) {
    glm::dvec3 origin{0};
    double spread = 0, reach = 0;
    for (int axis = 0; axis < 3 && !places.empty(); axis++) {
        std::vector<double> xs;
        for (const glm::dvec3& place : places) xs.push_back(place[axis]);
        origin[axis] = median(xs);
        for (double& x : xs) x = std::abs(x - origin[axis]);
        spread = std::max(spread, median(xs));
        reach = std::max(reach, *std::ranges::max_element(xs));
    }
    const double unit = chooseUnit(spread, reach);
    if (spread == 0) return {glm::dvec3{0}, unit};
    const double step = std::ldexp(1, std::ilogb(spread) + 4);
    for (int axis = 0; axis < 3; axis++) origin[axis] = step * std::round(origin[axis] / step);
    return {origin, unit};
}

} // namespace vkpm
