/// Albedos of GGX by quadrature in double precision.
#include "scene/rest.h"
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace vkpm {
namespace {

using glm::dvec3;

/// The length of a direction of cosine z after the ellipsoid of the facets became a sphere, see ggx.glsl.
double stretched(double alpha, double z) { return std::sqrt(z * z + alpha * alpha * (1 - z * z)); }

/// What one reflection does not return, by the facet under the point (u, v) of the cap of visible normals (Dupuy &
/// Benyoub 2023); small albedos keep their digits, and those near 1, too.
double lost(double alpha, double normalIncidence, double z, double u, double v) {
    const double stretch = stretched(alpha, z), height = u * (1 + z / stretch), phi = 2 * glm::pi<double>() * v,
                 radius = std::sqrt(height * (2 - height));
    const dvec3 facet{alpha * std::sqrt(1 - z * z) / stretch + radius * std::cos(phi), radius * std::sin(phi),
                      z / stretch + 1 - height};
    const dvec3 h = glm::normalize(dvec3{alpha * facet.x, alpha * facet.y, facet.z});
    const dvec3 wo{std::sqrt(1 - z * z), 0, z};
    const double cosine = glm::dot(wo, h), zi = 2 * cosine * h.z - z;
    if (zi <= 0) return 1;
    const double other = stretched(alpha, zi),
                 reflectance = normalIncidence + (1 - normalIncidence) * std::pow(1 - cosine, 5);
    const double masked = z * (other - zi) / (zi * stretch + z * other); // 1 - G2 / G1
    return 1 - reflectance + reflectance * masked;
}

/// The mean over the cap; nodes are dense at its rim, where steep facets are.
double restAt(double alpha, double normalIncidence, double z) {
    constexpr int steps = 96, turns = 48;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        const double t = (i + 0.5) / steps, u = 1 - std::pow(t, 4), weight = 4 * std::pow(t, 3) / steps;
        double ring = 0;
        for (int j = 0; j < turns; j++) ring += lost(alpha, normalIncidence, z, u, (j + 0.5) / (2 * turns));
        sum += weight * ring / turns;
    }
    return sum;
}

} // namespace

std::vector<float> restRow(double alpha, double normalIncidence) {
    std::vector<float> row;
    for (uint i = 0; i <= REST_STEPS; i++) {
        const double x = std::max(double(i) / REST_STEPS, 1e-3);
        row.push_back(static_cast<float>(restAt(alpha, normalIncidence, x * x)));
    }
    // The mean of the function that kernels make of it by lines in x, the root of the cosine: of 2 mu dmu = 4 x^3 dx.
    double mean = 0;
    for (uint i = 0; i < REST_STEPS; i++) {
        const double a = double(i) / REST_STEPS, b = double(i + 1) / REST_STEPS, from{row[i]}, to{row[i + 1]};
        const double slope = (to - from) / (b - a), at0 = from - slope * a;
        mean += at0 * (std::pow(b, 4) - std::pow(a, 4)) + 0.8 * slope * (std::pow(b, 5) - std::pow(a, 5));
    }
    row.push_back(static_cast<float>(mean));
    return row;
}

uint placeRows(std::vector<float>& rests, const std::vector<float>& rows) {
    for (std::size_t i = 0; i + rows.size() <= rests.size(); i += REST_ROW)
        if (std::equal(rows.begin(), rows.end(), rests.begin() + std::ptrdiff_t(i))) return uint(i / REST_ROW);
    rests.insert(rests.end(), rows.begin(), rows.end());
    return uint((rests.size() - rows.size()) / REST_ROW);
}

std::vector<float> standardRows(double alpha) {
    std::vector<float> rows = restRow(alpha, 0);
    const std::vector<float> metal = restRow(alpha, 1);
    rows.insert(rows.end(), metal.begin(), metal.end());
    return rows;
}

} // namespace vkpm
