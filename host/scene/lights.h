/// Area lights: their flux and the probabilities with which they are chosen.
#pragma once
#include "scene/scene.h"
#include "shared_scene.h"
#include <span>

namespace vkpm {

inline bool isEndless(const Light& light) { return (ENDLESS_KINDS >> light.kind & 1) != 0; }
inline bool isDelta(const Light& light) { return (DELTA_LIGHT_KINDS >> light.kind & 1) != 0; }

/// Gives lights that are endlessly far their area: their flux is what comes through the disc about all that is lit.
void measureEndless(Scene& scene);

/// Flux of a light in W: pi times area times radiance, for each side that emits.
glm::dvec3 lightFlux(const Light& light);

/// The cumulative distribution of weights, none negative and some positive, in whole steps of the random numbers that
/// lights are chosen by (2^-24), so that differences are exactly the probabilities. Where the weight is positive the
/// probability is, unless there are more than 2^23 of these.
std::vector<float> cumulative(std::span<const double> weights);

/// Fills `flux`, `lightCdf` and the lights' `share`. The probability of a light is the difference of its two entries of
/// the CDF, nearly in proportion to its flux. Throws InputError, naming `file`, if no light emits or the flux is beyond
/// the range of float.
void chooseLights(Scene& scene, const std::filesystem::path& file);

/// The sphere about the box of all that light falls upon: of all primitives but lights that reflect nothing.
Target sphereOfLit(const Scene& scene);

/// The sphere about all but far lights, a little wide, so that photons may start on it.
Target sphereOfNear(const Scene& scene);

/// Fills `middle`, about the middle of what is lit, if few primitives reach much farther than the others, such as the
/// ground of a meadow, and `discCount`.
void findMiddle(Scene& scene);

/// Whether a point of a light may be farther from the middle of Scene::lit than its diameter, see aimAtLit in
/// projection_map.glsl.
bool isFar(const Scene& scene, const Light& light);

} // namespace vkpm
