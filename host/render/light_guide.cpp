/// Regions of space, and what light samples choose by in each.
#include "render/light_guide.h"
#include "render/guide_tree.h"
#include "scene/lights.h"
#include "shared_guide.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace vkpm {

namespace {

const uint pointsApart = 8, maxLightsEach = 64; // one point of so many is asked about that many lights, so that each
                                                // is asked about at 64 points
const uint maxLightsByRegion = 8;               // of more lights, the distribution is the same everywhere

/// How finely the sky is asked about.
struct Fineness {
    uint samples;       // to each point
    std::size_t points; // of a region, about, at most twice as many
};
const Fineness coarse{4, 512}, fine{32, 64}; // to tell whether a guide is of use, and to make it
const double minSkyGain = 2;                 // of the variance of samples of the sky, for which they are guided
const double bySky = 0.25;                   // of a tree's samples go by the sky alone

double probability(std::span<const float> cdf, std::size_t i) {
    return double{cdf[i]} - (i > 0 ? double{cdf[i - 1]} : 0);
}

/// Mixes `bySky` of uniform samples into those of a box, which holds a part `mass` of them in a part `volume` of space.
void mixUniform(std::vector<GuideNode>& nodes, uint box, double mass, double volume) {
    GuideNode& node = nodes[box];
    if (node.axis == NONE) return;
    const auto mixed = [](double guided, double uniform) { return (1 - bySky) * guided + bySky * uniform; };
    const double lower = mass * double{node.lower};
    mixUniform(nodes, node.child, lower, volume / 2);
    mixUniform(nodes, node.child + 1, mass - lower, volume / 2);
    node.lower = static_cast<float>(mixed(lower, volume / 2) / mixed(mass, volume));
}

/// Cuts space at about the medians of points until each region has few, and gives each a tree over the numbers of its
/// samples.
class Regions {
public:
    Regions(std::span<const Split> places, std::span<const LightContribution> brought, Fineness how, uint lightsEach)
        : splits(places), samples(brought), fineness(how), lights(lightsEach) {
        std::vector<uint> seen;
        for (uint i = 0; i < splits.size(); i++)
            if (splits[i].flags != NONE) seen.push_back(i);
        if (seen.empty()) return;
        nodes.push_back({});
        build(seen, 0);
    }

    /// The variance of samples without a guide over that of guided ones.
    double gain() const { return left > 0 ? all / left : 1; }

    std::vector<GuideNode> nodes;
    std::vector<std::vector<uint>> points; // by region

private:
    void build(std::span<uint> held, uint node) {
        if (held.size() > 2 * fineness.points && cut(held, node)) return;
        // The lights of all space are first.
        const auto firstLight = static_cast<float>(lights * (1 + points.size()));
        nodes[node] = {LIGHT_GUIDE_REGION, firstLight, static_cast<uint>(nodes.size())};
        points.emplace_back(held.begin(), held.end());
        addTree(held);
    }

    /// Across the longest side of the points' box.
    bool cut(std::span<uint> held, uint node) {
        vec3 low = splits[held[0]].origin, high = low;
        for (const uint i : held) low = glm::min(low, splits[i].origin), high = glm::max(high, splits[i].origin);
        const vec3 sides = high - low;
        const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
        const auto along = [&](uint i) { return splits[i].origin[axis]; };
        std::ranges::sort(held, {}, [&](uint i) { return std::pair{along(i), i}; });
        // Many may lie in one plane, which is left whole.
        const auto [first, last] = std::ranges::equal_range(held, along(held[held.size() / 2]), {}, along);
        const auto middle = first != held.begin() ? first : last;
        if (middle == held.end()) return false;
        const auto lower = static_cast<std::size_t>(middle - held.begin());
        const uint child = static_cast<uint>(nodes.size());
        nodes[node] = {static_cast<uint>(axis), along(*middle), child};
        nodes.resize(child + 2);
        build(held.first(lower), child);
        build(held.subspan(lower), child + 1);
        return true;
    }

    void addTree(std::span<const uint> held) {
        std::vector<PrimarySample> starts;
        for (const uint i : held)
            for (const LightContribution& sample : samples.subspan(std::size_t(i) * fineness.samples, fineness.samples))
                starts.push_back({.numbers = {0, 0, sample.numbers.x, sample.numbers.y, 0, 0, 0},
                                  .weight = sample.value,
                                  .inverseDensity = 1,
                                  .stored = 0,
                                  .seen = sample.value > 0,
                                  .place = {}});
        std::array<bool, PRIMARY_DIMENSIONS> axes{};
        axes[PRIMARY_POSITION] = axes[PRIMARY_POSITION + 1] = true;
        GuideTree tree = guideTree(starts, axes);
        mixUniform(tree.nodes, 0, 1, 1);
        const auto first = static_cast<uint>(nodes.size());
        for (GuideNode node : tree.nodes) {
            if (node.axis != NONE) node.axis -= PRIMARY_POSITION, node.child += first;
            nodes.push_back(node);
        }
        all += double(held.size());
        left += double(held.size()) / tree.gain;
    }

    std::span<const Split> splits;
    std::span<const LightContribution> samples;
    Fineness fineness;
    uint lights;
    double all = 0, left = 0; // variance, in parts of that of a point without a guide
};

/// Roots of the mean squares of what lights bring to a point, in parts of all light there; dim points, where nobody
/// sees noise, count less. Two answers that a light brings what `expected` says stand for what was not asked. A tenth
/// is by that alone.
std::vector<float> byLight(std::span<const float> values, std::span<const float> expected, std::size_t each) {
    const std::size_t lights = expected.size();
    std::vector<double> all(values.size() / each), squares(lights), asked(lights);
    double mean = 0, found = 0, wanted = 0;
    for (std::size_t i = 0; i < values.size(); i++) all[i / each] += double(values[i]) * double(lights) / double(each);
    for (const double light : all) mean += light / double(all.size());
    const auto part = [&](std::size_t light) { return probability(expected, light); };
    for (std::size_t i = 0; i < values.size() && mean > 0; i++) {
        const double brings = values[i] / (all[i / each] + 0.1 * mean);
        squares[i % lights] += brings * brings;
        asked[i % lights]++;
        found += brings * brings;
        wanted += part(i % lights) * part(i % lights);
    }
    std::vector<double> weights(lights);
    for (std::size_t i = 0; i < lights; i++)
        weights[i] =
            std::sqrt((squares[i] + 2 * part(i) * part(i) * (found > 0 ? found / wanted : 1)) / (asked[i] + 2));
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < lights; i++) weights[i] = 0.9 * weights[i] / total + 0.1 * part(i);
    return cumulative(weights);
}

std::vector<float> valuesOf(std::span<const LightContribution> brought) {
    std::vector<float> values;
    for (const LightContribution& light : brought) values.push_back(light.value);
    return values;
}

} // namespace

void learnLights(Gpu& gpu, UploadedScene& scene, const Features& features, uint seed, const GuideNeeds& needs,
                 const CameraPilot& places, std::span<const float> byFlux) {
    const Buffer<Split>& splits = places.paths.splitPoints();
    const Kernel<LightContributionArgs> weigh(gpu, "light_contribution", features);
    const auto ask = [&](uint each, uint apart, uint light, bool guided) {
        const uint count = static_cast<uint>(splits.size()) / apart * each;
        const Buffer<LightContribution> values(gpu, "light values", count);
        Recording recording(gpu);
        recording.run(weigh, count, {scene.address, splits, values, count, each, apart, seed, light, guided});
        recording.submit();
        std::vector<LightContribution> brought = values.download();
        for (LightContribution& sample : brought)
            if (!std::isfinite(sample.value)) sample.value = 0;
        return brought;
    };

    const auto lights = static_cast<uint>(byFlux.size());
    std::vector<float> cdf(byFlux.begin(), byFlux.end());
    if (needs.lights) {
        const uint each = std::min(lights, maxLightsEach);
        cdf = byLight(valuesOf(ask(each, pointsApart, NONE, false)), byFlux, each);
    }
    scene.guideLights(gpu, {}); // at no time does a guide ask for lights that are not there
    scene.chooseLights(gpu, cdf);
    if (!needs.sky) return;
    const bool choose = lights > 1 && lights <= maxLightsByRegion;
    const std::vector<Split> seen = splits.download();
    const auto learned = [&](Fineness how) {
        return Regions(seen, ask(how.samples, 1, *needs.sky, false), how, choose ? lights : 0);
    };
    if (learned(coarse).gain() < minSkyGain) return;
    const Regions regions = learned(fine);
    const std::vector<float> everywhere = cdf;
    for (std::size_t i = 0; choose && i < regions.points.size(); i++)
        cdf.insert(cdf.end(), everywhere.begin(), everywhere.end());
    scene.chooseLights(gpu, cdf);
    scene.guideLights(gpu, regions.nodes);
    if (!choose) return;
    const std::vector<float> brought = valuesOf(ask(lights, 1, NONE, true));
    auto next = cdf.begin() + lights;
    for (const std::vector<uint>& points : regions.points) {
        std::vector<float> there;
        for (const uint point : points)
            for (uint light = 0; light < lights; light++) there.push_back(brought[point * lights + light]);
        next = std::ranges::copy(byLight(there, everywhere, lights), next).out;
    }
    scene.chooseLights(gpu, cdf);
}

} // namespace vkpm
