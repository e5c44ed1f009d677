/// Drafts: their size and their settings.
#include "window/draft.h"
#include <algorithm>
#include <chrono>

namespace vkpm {
namespace {

const double secondsPerFrame = 0.05; // wanted; the window needs some time beside
const double finest = 0.5, coarsest = 1.0 / 32;
const uint maxPhotons = 50'000;

Settings draftSettings(Settings settings) {
    settings.size = {16, 16};
    settings.photons = std::min(settings.photons, maxPhotons);
    settings.causticPhotons = std::min(settings.causticPhotons, maxPhotons);
    settings.gatherRays = 1;
    settings.guides = false;
    return settings;
}

} // namespace

Draft::Draft(Gpu& gpu, const Scene& scene, const Settings& settings)
    : scale(std::clamp(128.0 / std::max(settings.size.x, settings.size.y), coarsest, finest)),
      renderer(gpu, scene, draftSettings(settings)) {
    renderer.renderPass(0); // makes the maps
}

uvec2 Draft::sizeFor(uvec2 film) const { return glm::max(uvec2(glm::dvec2(film) * scale + 0.5), uvec2(1)); }

/// Rarely, and by much: a change of size shows.
void Draft::adapt(double seconds) {
    const double ratio = secondsPerFrame / seconds;
    if (ratio < 0.75 || ratio > 2)
        scale = std::clamp(scale * std::sqrt(std::clamp(ratio, 0.25, 1.5)), coarsest, finest);
}

Picture Draft::render(const View& view, uvec2 film) {
    const auto start = std::chrono::steady_clock::now();
    const uvec2 size = sizeFor(film);
    renderer.setView(view, size);
    renderer.renderPass(0);
    Picture picture{.pixels = renderer.film.download(), .size = size, .view = view, .passes = 1, .draft = true};
    adapt(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return picture;
}

} // namespace vkpm
