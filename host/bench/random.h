/// Random numbers for the benchmark, the same each time.
#pragma once
#include "shared.h"
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

namespace vkpm {

class Random {
public:
    float uniform() { return std::uniform_real_distribution<float>()(engine); }
    uint below(std::size_t count) { return static_cast<uint>(engine() % count); }
    vec3 direction() {
        const float z = 1 - 2 * uniform(), phi = glm::two_pi<float>() * uniform();
        return vec3(std::sqrt(1 - z * z) * vec2(std::cos(phi), std::sin(phi)), z);
    }

private:
    std::mt19937 engine{1};
};

} // namespace vkpm
