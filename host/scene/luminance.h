/// Luminance of linear Rec. 709 colours; that of kernels is in common.glsl.
#pragma once
#include <glm/glm.hpp>

namespace vkpm {

template <class Number> Number luminance(const glm::vec<3, Number>& color) {
    return glm::dot(color, glm::vec<3, Number>(0.2126, 0.7152, 0.0722));
}

} // namespace vkpm
