/// Area lights: flux and probabilities.
#include "scene/lights.h"
#include "scene/text.h"
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace vkpm {
using glm::dvec3;

double luminance(dvec3 color) { return glm::dot(color, dvec3{0.2126, 0.7152, 0.0722}); }

dvec3 lightFlux(const Light& light) {
    const double sides = light.twoSided != 0 ? 2 : 1;
    return sides * glm::pi<double>() * double{light.area} * dvec3{light.radiance};
}

void chooseLights(Scene& scene, const std::filesystem::path& file) {
    dvec3 flux{0};
    for (const Light& light : scene.lights) flux += lightFlux(light);
    scene.flux = vec3{flux};
    const double total = luminance(flux);
    if (scene.lights.empty() || scene.flux == vec3{0})
        refuseFile(file, ": /shapes", "there is no light", "give a shape an \"emission\" above 0");
    if (!std::isfinite(scene.flux.x + scene.flux.y + scene.flux.z))
        refuseFile(file, ": /shapes", "the flux of all lights overflows", "lower \"emission\"");

    double sum = 0;
    float low = 0;
    for (Light& light : scene.lights) {
        sum += luminance(lightFlux(light));
        const float high = &light == &scene.lights.back() ? 1.0f : static_cast<float>(std::min(sum / total, 1.0));
        light.probability = high - low;
        scene.lightCdf.push_back(high);
        low = high;
    }
}

} // namespace vkpm
