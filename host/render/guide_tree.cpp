/// Boxes are cut where that saves most, until too few photons are left in them; then cuts that do not pay are undone.
#include "render/guide_tree.h"
#include "shared_photons.h"
#include <algorithm>
#include <cmath>

namespace vkpm {
namespace {

const std::size_t fewSamples = 64;   // in a box that is not cut any more
const float narrowest = 1.0f / 4096; // half of a box
const double minSaving = 0.01;       // of a box's effort, for its cuts to stay
const std::array<uint, PRIMARY_DIMENSIONS> order{PRIMARY_DIRECTION, PRIMARY_DIRECTION + 1, PRIMARY_TARGET,
                                                 PRIMARY_LIGHT,     PRIMARY_POSITION,      PRIMARY_POSITION + 1,
                                                 PRIMARY_SIDE};

// What a photon costs in units of one that is stored nowhere: there are more rays, and it is sorted and read.
float costOf(const PrimarySample& start) { return 1 + 2 * float(start.stored); }

/// What is asked of a photon again and again, with the density of uniform ones.
struct PilotSample {
    std::array<float, PRIMARY_DIMENSIONS> numbers;
    float all; // their density over that with which it was started
    float cost;
    double useful; // square of what it adds, which may be a far light's 10^-40

    explicit PilotSample(const PrimarySample& start)
        : all(start.inverseDensity), cost(all * costOf(start)),
          useful(double(all) * start.weight * start.weight * start.seen) {
        std::ranges::copy(start.numbers, numbers.begin());
    }
};

/// Over photons of a box.
struct Sums {
    double photons = 0;
    double all = 0;
    double cost = 0;
    double useful = 0;
    double useful2 = 0; // squares

    void add(const PilotSample& sample) {
        photons += 1;
        all += sample.all;
        cost += sample.cost;
        useful += sample.useful;
        useful2 += sample.useful * sample.useful;
    }
    /// Useful photons, were all alike.
    double effective() const { return useful2 > 0 ? useful * useful / useful2 : 0; }
};

struct Box {
    std::array<float, PRIMARY_DIMENSIONS> low{};
    std::array<float, PRIMARY_DIMENSIONS> width{1, 1, 1, 1, 1, 1, 1};
    double volume = 1;

    float middle(uint axis) const { return low[axis] + width[axis] / 2; }
    Box half(uint axis, bool upper) const {
        Box box = *this;
        if (upper) box.low[axis] = middle(axis);
        box.width[axis] /= 2;
        box.volume /= 2;
        return box;
    }
};

/// Of a box, and so of a part of the tree: to be summed.
struct Share {
    double photons = 0;  // that it gets, in units that are the same everywhere,
    double effort = 0;   // root of their cost times their variance
    double variance = 0; // of uniform photons,
    double cost = 0;     // and what they cost
    double left = 0;     // variance of guided photons

    Share operator+(const Share& o) const {
        return {photons + o.photons, effort + o.effort, variance + o.variance, cost + o.cost, left + o.left};
    }
};

class Builder {
public:
    Builder(std::vector<PilotSample>& given, const std::array<bool, PRIMARY_DIMENSIONS>& which) : axes(which) {
        Sums sums;
        for (const PilotSample& sample : given) sums.add(sample);
        mean = sums.all > 0 ? sums.useful / sums.all : 0;
        tree.nodes.push_back({NONE, 0, 0});
        if (mean == 0) return;
        const Share whole = build(given, Box{}, 0);
        tree.gain = whole.variance * whole.cost / (whole.effort * whole.effort);
        tree.density = whole.variance / (whole.left * whole.photons);
    }

    GuideTree tree;

private:
    /// The mean square of what a photon of a box adds. Half of a photon of the mean of all stands for what was not met,
    /// so that no box goes without (the estimator of Krichevsky & Trofimov 1981).
    double meanSquare(const Sums& sums) const {
        const double found = sums.all > 0 ? sums.useful / sums.all * sums.photons : 0;
        return (found + 0.5 * mean) / (sums.photons + 1);
    }

    static double meanCost(const Sums& sums) { return sums.all > 0 ? sums.cost / sums.all : 1; }

    double effort(const Sums& sums) const { return std::sqrt(meanSquare(sums) * meanCost(sums)); }

    Share shareOf(const Sums& sums, double volume) const {
        const double square = meanSquare(sums), cost = meanCost(sums), photons = std::sqrt(square / cost);
        return {volume * photons, volume * effort(sums), volume * square, volume * cost, volume * square / photons};
    }

    /// The axis to cut: that which saves most effort or, if chance alone would save as much, the widest.
    uint axisFor(std::span<const PilotSample> samples, const Box& box, const Sums& whole) const {
        uint best = NONE, widest = NONE;
        double least = 2 * effort(whole) * (1 - 1 / std::max(whole.effective(), 1.0));
        for (const uint axis : order) {
            if (!axes[axis] || box.width[axis] / 2 < narrowest) continue;
            if (widest == NONE || box.width[axis] > box.width[widest]) widest = axis;
            std::array<Sums, 2> halves;
            const float middle = box.middle(axis);
            for (const PilotSample& sample : samples) halves[sample.numbers[axis] >= middle].add(sample);
            const double both = effort(halves[0]) + effort(halves[1]);
            if (both < least) least = both, best = axis;
        }
        return best != NONE ? best : widest;
    }

    /// Fills a node and those below.
    Share build(std::span<PilotSample> samples, const Box& box, uint node) {
        Sums sums;
        for (const PilotSample& sample : samples) sums.add(sample);
        const Share uncut = shareOf(sums, box.volume);
        const uint axis = samples.size() < fewSamples || sums.useful == 0 ? NONE : axisFor(samples, box, sums);
        if (axis == NONE) return uncut;

        const auto upper = std::partition(samples.begin(), samples.end(), [&](const PilotSample& sample) {
            return sample.numbers[axis] < box.middle(axis);
        });
        const uint child = static_cast<uint>(tree.nodes.size());
        tree.nodes.resize(child + 2, {NONE, 0, 0});
        const Share lower = build({samples.begin(), upper}, box.half(axis, false), child);
        const Share both = lower + build({upper, samples.end()}, box.half(axis, true), child + 1);
        if (both.effort > (1 - minSaving) * uncut.effort) {
            tree.nodes.resize(child);
            return uncut;
        }
        tree.nodes[node] = {axis, static_cast<float>(lower.photons / both.photons), child};
        return both;
    }

    std::array<bool, PRIMARY_DIMENSIONS> axes;
    double mean = 0; // square of what a photon adds
};

} // namespace

GuideTree guideTree(std::span<const PrimarySample> starts, const std::array<bool, PRIMARY_DIMENSIONS>& axes) {
    std::vector<PilotSample> samples(starts.begin(), starts.end());
    return Builder(samples, axes).tree;
}

} // namespace vkpm
