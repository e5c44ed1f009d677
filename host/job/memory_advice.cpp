/// How many photons fit into the memory of a device.
#include "job/memory_advice.h"
#include "gpu/buffer.h"
#include "render/renderer.h"
#include "shared_film.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <vector>

namespace vkpm {
namespace {

/// The settings with no more photons of either kind than `most`.
Settings limited(Settings settings, uint most) {
    settings.photons = std::min(settings.photons, most);
    settings.causticPhotons = std::min(settings.causticPhotons, most);
    return settings;
}

/// The bytes that a pass with no more photons of either kind takes at most, beside all that the film comes to hold;
/// nothing if that does not fit.
std::optional<double> bytesWith(Gpu& gpu, const Scene& scene, const Settings& settings, uint photons) {
    try {
        gpu.peakBytes = 0;
        Renderer renderer(gpu, scene, limited(settings, photons));
        const RawBuffer runs(gpu, "film", bytesOfFurtherRuns(renderer.features(), settings));
        renderer.renderPass(0);
        return double(gpu.peakBytes);
    } catch (const OutOfMemory&) {
        return {};
    }
}

/// The bytes that the device has left, found by taking them, in pieces down to a mebibyte.
double bytesLeft(Gpu& gpu) {
    std::vector<RawBuffer> pieces;
    double sum = 0;
    for (std::uint64_t size = 1 << 30; size >= 1 << 20;) try {
            pieces.emplace_back(gpu, "trial", size);
            sum += double(size);
        } catch (const OutOfMemory&) {
            size /= 2;
        }
    return sum;
}

/// Two leading digits, rounded down.
uint rounded(double count) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(count)) - 1));
    return static_cast<uint>(std::floor(count / unit) * unit);
}

/// About the most photons that fit, below a number that does not; 0 if it is not worth while to look for fewer. Two
/// small passes say what a photon takes.
uint maxPhotons(Gpu& gpu, const Scene& scene, const Settings& settings, uint tooMany) {
    const uint least = 1000;
    uint photons = std::min(BatchSizes{}.photons, tooMany / 4);
    std::optional<double> few = bytesWith(gpu, scene, settings, photons);
    while (!few && photons / 4 >= least) few = bytesWith(gpu, scene, settings, photons /= 4);
    if (!few) return 0;
    const std::optional<double> more = bytesWith(gpu, scene, settings, 2 * photons);
    if (!more) return rounded(photons);
    const double each = std::max(*more - *few, 1.0) / photons;
    uint most = rounded(std::min(photons + (bytesLeft(gpu) - *few) / each, double(tooMany)));
    while (most > 2 * photons && !bytesWith(gpu, scene, settings, most)) most = rounded(0.9 * most);
    return most;
}

} // namespace

std::uint64_t bytesOfFurtherRuns(const Features& features, const Settings& settings) {
    const std::uint64_t pixels = std::uint64_t(settings.size.x) * settings.size.y;
    return (maxRuns(settings.passes) - 1) * pixels * Columns(features).SUM_COLUMNS * sizeof(float);
}

std::string memoryAdvice(Gpu& gpu, const Scene& scene, const Settings& settings) {
    const uint asked = std::max(settings.photons, settings.causticPhotons);
    const uint most = maxPhotons(gpu, scene, settings, asked);
    if (most == 0)
        return fmt::format("an image of {}x{} pixels and this scene do not fit with a thousand photons either: ask for "
                           "a smaller image (--size) or for fewer layers (--layers)",
                           settings.size.x, settings.size.y);
    return fmt::format("about {} photons per pass fit: --photons {} --caustic-photons {}", most,
                       std::min(settings.photons, most), std::min(settings.causticPhotons, most));
}

} // namespace vkpm
