/// A scene with a closed form: a floor that sees a lamp in a mirror, and references of layers as lists of numbers.
#pragma once
#include "output/image.h"
#include "render_support.h"
#include "shared_scene.h"
#include <numbers>

namespace vkpm {

/// Means of a layer by pixel, channels one after another.
using Values = std::vector<double>;

// The lamp at height 0.3 shines up at a mirror in the ceiling at 0.6. The floor is lit as by the lamp's image at height
// 0.9.

inline const double imageHeight = 0.9, lampLow = -0.6, lampHigh = -0.4, radiance = 10;

inline nlohmann::json lampInMirror() {
    return {
        {"camera", {{"origin", {0.2, 0.55, 1.0}}, {"target", {0.2, 0, 0}}, {"up", {0, 1, 0}}, {"fieldOfView", 25}}},
        {"film", {{"size", {12, 12}}}},
        {"materials",
         {{"white", {{"type", "diffuse"}, {"albedo", 1.0}}}, {"mirror", {{"type", "mirror"}, {"reflectance", 1}}}}},
        {"shapes",
         {{{"type", "rectangle"}, {"corner", {-3, 0, 3}}, {"edges", {{6, 0, 0}, {0, 0, -6}}}, {"material", "white"}},
          {{"type", "rectangle"}, {"corner", {-3, 0.6, -3}}, {"edges", {{6, 0, 0}, {0, 0, 6}}}, {"material", "mirror"}},
          {{"type", "rectangle"},
           {"corner", {lampLow, 0.3, 0.1}},
           {"edges", {{lampHigh - lampLow, 0, 0}, {0, 0, -0.2}}},
           {"emission", radiance}}}}};
}

// Form factor from a point to a parallel rectangle with a corner above it, sides x and y at distance 1 (Howell's
// catalogue, B-3).
inline double cornerFactor(double x, double y) {
    const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
    return (x / u * std::atan(y / u) + y / v * std::atan(x / v)) / (2 * std::numbers::pi);
}

inline double floorRadiance(double x, double z) {
    const auto corner = [&](double lampX, double lampZ) {
        return cornerFactor((lampX - x) / imageHeight, (lampZ - z) / imageHeight);
    };
    return radiance * (corner(lampHigh, 0.1) - corner(lampLow, 0.1) - corner(lampHigh, -0.1) + corner(lampLow, -0.1));
}

// Means over pixels, from 8 x 8 points of each.
inline Values floorTruth(const Scene& scene, uvec2 size) {
    const Camera camera = pinholeCamera(scene.view, size);
    Values values;
    for (uint pixel = 0; pixel < size.x * size.y; pixel++) {
        double sum = 0;
        for (uint k = 0; k < 64; k++) {
            const double x = (pixel % size.x + (k % 8 + 0.5) / 8) / size.x,
                         y = (pixel / size.x + (k / 8 + 0.5) / 8) / size.y;
            const glm::dvec3 direction = glm::dvec3(camera.forward) + (2 * x - 1) * glm::dvec3(camera.right) +
                                         (1 - 2 * y) * glm::dvec3(camera.up);
            const glm::dvec3 point = glm::dvec3(camera.origin) - direction * (double(camera.origin.y) / direction.y);
            sum += floorRadiance(point.x, point.z) / 64;
        }
        for (int c = 0; c < 3; c++) values.push_back(sum);
    }
    return values;
}

/// A layer of a reference image; beauty is "".
inline Values referenceLayer(const Image& image, const std::string& layer) {
    Values values(3 * std::size_t(image.size.x) * image.size.y);
    for (const Channel& channel : image.channels)
        for (std::size_t c = 0; c < 3; c++)
            if (channel.name == (layer.empty() ? "" : layer + ".") + "RGB"[c])
                for (std::size_t i = 0; i < channel.values.size(); i++) values[3 * i + c] = channel.values[i];
    return values;
}

} // namespace vkpm
