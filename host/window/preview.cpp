/// Previews: their size and their settings.
#include "window/preview.h"
#include <algorithm>
#include <chrono>

namespace vkpm {
namespace {

const double secondsPerFrame = 0.05; // wanted; the window needs some time beside
const double finest = 0.5, coarsest = 1.0 / 32;
const uint maxPhotons = 50'000;

Settings previewSettings(Settings settings) {
    settings.size = {16, 16};
    settings.photons = std::min(settings.photons, maxPhotons);
    settings.causticPhotons = std::min(settings.causticPhotons, maxPhotons);
    settings.pixelSamples = 1;
    settings.gatherRays = 1;
    settings.guides = false;
    return settings;
}

} // namespace

Preview::Preview(Gpu& gpu, const Scene& scene, const Settings& settings)
    : scale(std::clamp(128.0 / std::max(settings.size.x, settings.size.y), coarsest, finest)),
      renderer(gpu, scene, previewSettings(settings)) {
    renderer.renderPass(0); // makes the maps
}

Picture Preview::render(const View& view, uvec2 film) {
    const auto start = std::chrono::steady_clock::now();
    const uvec2 size = glm::max(uvec2(glm::dvec2(film) * scale + 0.5), uvec2(1));
    renderer.setView(view, size);
    renderer.renderPass(0);
    Picture picture{.pixels = renderer.film.download(), .size = size, .view = view, .passes = 1, .preview = true};

    // The size changes rarely, and by much, since a change shows.
    const double ratio =
        secondsPerFrame / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (ratio < 0.75 || ratio > 2)
        scale = std::clamp(scale * std::sqrt(std::clamp(ratio, 0.25, 1.5)), coarsest, finest);
    return picture;
}

} // namespace vkpm
