/// How many photons fit into the memory of a device.
#include "job/memory_advice.h"
#include "gpu/buffer.h"
#include "render/renderer.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace vkpm {
namespace {

/// What a render takes with some number of photons.
struct Needs {
    std::map<std::string, std::uint64_t> bytes; // by buffer
    double photons = 0;
    double stored = 0; // of both maps
};

/// The settings with no more photons of either kind than `most`.
Settings limited(Settings settings, uint most) {
    settings.photons = std::min(settings.photons, most);
    settings.causticPhotons = std::min(settings.causticPhotons, most);
    return settings;
}

/// Renders a pass with a number of photons; nothing if that does not fit.
std::optional<Needs> measure(Gpu& gpu, const Scene& scene, const Settings& settings, uint photons) {
    try {
        const Settings few = limited(settings, photons);
        Renderer renderer(gpu, scene, few);
        renderer.renderPass(0);
        Needs needs{gpu.memory, double(photons), 0};
        needs.bytes["film"] *= maxRuns(settings.passes);
        for (const MapKind kind : {MapKind::global, MapKind::caustic})
            needs.stored = std::max(needs.stored, double(renderer.photons(kind).stored));
        return needs;
    } catch (const OutOfMemory&) {
        return {};
    }
}

/// Needs at more photons than in two renders. Tables of cells double where photons do, up to 2^26 cells; all else grows
/// steadily.
Needs extrapolated(const Needs& few, const Needs& more, double photons) {
    Needs needs = more;
    const auto doublings = [&](double count) {
        return std::bit_width(static_cast<std::uint64_t>(more.stored * count / more.photons));
    };
    for (auto& [name, bytes] : needs.bytes) {
        const double before = few.bytes.contains(name) ? double(few.bytes.at(name)) : 0,
                     slope = (double(bytes) - before) / (more.photons - few.photons);
        if (name.ends_with(" cells"))
            bytes = std::max(bytes, std::min<std::uint64_t>(bytes << (doublings(photons) - doublings(more.photons)),
                                                            4 * ((1ull << 26) + 1)));
        else bytes = static_cast<std::uint64_t>(double(bytes) + std::max(slope, 0.0) * (photons - more.photons));
    }
    return needs;
}

bool fits(Gpu& gpu, const Needs& needs) {
    std::vector<RawBuffer> buffers;
    try {
        for (const auto& [name, bytes] : needs.bytes) buffers.emplace_back(gpu, name, bytes);
    } catch (const OutOfMemory&) {
        return false;
    }
    return true;
}

/// Two leading digits, rounded down.
uint rounded(double count) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(count)) - 1));
    return static_cast<uint>(std::floor(count / unit) * unit);
}

/// About the most photons that fit, below a number that does not; 0 if it is not worth while to look for fewer.
uint maxPhotons(Gpu& gpu, const Scene& scene, const Settings& settings, uint tooMany) {
    const uint least = 1000;
    uint photons = std::min(BatchSizes{}.photons, tooMany / 4);
    std::optional<Needs> few = measure(gpu, scene, settings, photons);
    while (!few && photons / 4 >= least) few = measure(gpu, scene, settings, photons /= 4);
    if (!few) return 0;
    const std::optional<Needs> more = measure(gpu, scene, settings, 2 * photons);
    if (!more) return rounded(photons);
    double low = more->photons, high = tooMany;
    while (high / low > 1.01) {
        const double middle = std::sqrt(low * high);
        (fits(gpu, extrapolated(*few, *more, middle)) ? low : high) = middle;
    }
    // Some buffers live for a moment only: the last word has a render.
    uint most = rounded(low);
    while (most > 2 * photons && !measure(gpu, scene, settings, most)) most = rounded(0.95 * most);
    return most;
}

} // namespace

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
