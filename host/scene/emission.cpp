/// Means of textures over lights.
#include "scene/emission.h"
#include "scene/luminance.h"
#include "scene/textures.h"
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace vkpm {
namespace {

using glm::dvec2, glm::dvec3;

/// A direction on the image, of one in coordinates, in texels.
dvec2 inTexels(const EmissionPart& part, dvec2 along) {
    const TexelImage& image = part.arrays.images[part.texture.image];
    const dvec3 a{along, 0};
    return {glm::dot(dvec3{part.texture.u}, a) * image.width, glm::dot(dvec3{part.texture.v}, a) * image.height};
}

/// How many texels lie along a side.
double texelsAlong(const EmissionPart& part, dvec2 side) {
    const dvec2 texels = glm::abs(inTexels(part, side));
    return std::max(texels.x, texels.y);
}

/// Two samples a texel, or eight of few, within limits.
int samplesAlong(const EmissionPart& part, dvec2 side, int most) {
    const double texels = std::ceil(texelsAlong(part, side));
    return static_cast<int>(std::clamp(texels * (texels < 8 ? 8 : 2), 2.0, double(most)));
}

dvec3 emissionAt(const EmissionPart& part, dvec2 at) {
    return dvec3{part.texture.factor} * dvec3{textureAt(part.arrays, part.texture, at)};
}

dvec3 meanOfSphere(const EmissionPart& part) {
    const TexelImage& image = part.arrays.images[part.texture.image];
    const int columns = static_cast<int>(std::min(2 * image.width, 1024u)),
              rows = static_cast<int>(std::min(2 * image.height, 512u));
    dvec3 sum{0};
    for (int j = 0; j < rows; j++) {
        const double v = (j + 0.5) / rows, weight = std::sin(glm::pi<double>() * v);
        for (int i = 0; i < columns; i++) sum += weight * emissionAt(part, {(i + 0.5) / columns, v});
    }
    return sum * glm::pi<double>() / (2.0 * rows * columns);
}

dvec3 meanOfFlat(const EmissionPart& part) {
    const bool triangle = part.kind == LIGHT_TRIANGLE;
    const int most = triangle ? 64 : 2048, n = samplesAlong(part, part.u, most), m = samplesAlong(part, part.v, most);
    dvec3 sum{0};
    double count = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            const double x = (i + 0.5) / n, y = (j + 0.5) / m;
            if (triangle && x + y > 1) continue;
            sum += emissionAt(part, part.corner + x * part.u + y * part.v);
            count++;
        }
    return count > 0 ? sum / count : emissionAt(part, part.corner + (part.u + part.v) / 3.0);
}

/// The brightest of all texels that a part may show, by the box about it.
double greatest(const EmissionPart& part) {
    const TexelImage& image = part.arrays.images[part.texture.image];
    const dvec2 base = inTexels(part, part.corner) +
                       dvec2{double{part.texture.u.z} * image.width, double{part.texture.v.z} * image.height};
    dvec2 low = base, high = base;
    for (const dvec2 side : {part.u, part.v, part.u + part.v}) {
        low = glm::min(low, base + inTexels(part, side));
        high = glm::max(high, base + inTexels(part, side));
    }
    const bool whole = part.kind == LIGHT_SPHERE || high.x - low.x >= image.width || high.y - low.y >= image.height ||
                       !(glm::length(base) < 1e9);
    if (whole) low = dvec2{1}, high = dvec2{image.width, image.height} - 2.0;
    double most = 0;
    for (auto y = std::int64_t(std::floor(low.y)) - 1; y <= std::int64_t(std::floor(high.y)) + 1; y++)
        for (auto x = std::int64_t(std::floor(low.x)) - 1; x <= std::int64_t(std::floor(high.x)) + 1; x++) {
            const dvec3 texel{texelOf(part.arrays, image, wrapped(x, image.width, part.texture.wrapU),
                                      wrapped(y, image.height, part.texture.wrapV))};
            most = std::max(most, luminance(dvec3{part.texture.factor} * texel));
        }
    return most;
}

} // namespace

dvec3 meanEmission(const EmissionPart& part) {
    const double most = greatest(part);
    if (most == 0) return dvec3{0};
    const dvec3 mean = part.kind == LIGHT_SPHERE ? meanOfSphere(part) : meanOfFlat(part);
    return luminance(mean) > 1e-3 * most ? mean : mean + dvec3{1e-3 * most}; // what samples may have missed
}

glm::uvec2 partsOf(const EmissionPart& rectangle) {
    if (greatest(rectangle) <= 2 * luminance(meanEmission(rectangle))) return {1, 1};
    const auto along = [&](dvec2 side) { return uint(std::clamp(texelsAlong(rectangle, side), 1.0, 16.0)); };
    return {along(rectangle.u), along(rectangle.v)};
}

} // namespace vkpm
