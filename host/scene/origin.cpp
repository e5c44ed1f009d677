/// The choice of an origin.
#include "scene/origin.h"
#include <algorithm>
#include <cmath>

namespace vkpm {

static double median(std::vector<double> xs) {
    const auto middle = xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2);
    std::ranges::nth_element(xs, middle);
    return *middle;
}

glm::dvec3 chooseOrigin(const std::vector<glm::dvec3>& places) {
    glm::dvec3 origin{0};
    double spread = 0;
    for (int axis = 0; axis < 3 && !places.empty(); axis++) {
        std::vector<double> xs;
        for (const glm::dvec3& place : places) xs.push_back(place[axis]);
        origin[axis] = median(xs);
        for (double& x : xs) x = std::abs(x - origin[axis]);
        spread = std::max(spread, median(xs));
    }
    if (spread == 0) return glm::dvec3{0};
    const double step = std::ldexp(1, std::ilogb(spread) + 4);
    for (int axis = 0; axis < 3; axis++) origin[axis] = step * std::round(origin[axis] / step);
    return origin;
}

} // namespace vkpm
