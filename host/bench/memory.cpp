/// The speed of sorting and of copying.
#include "bench/memory.h"
#include "render/sort.h"
#include "shared_photons.h"
#include <algorithm>
#include <cstring>
#include <execution>
#include <numeric>
#include <random>
#include <tbb/parallel_for.h>

namespace vkpm {
namespace {

constexpr std::size_t pairCount = 1u << 20;
constexpr std::size_t copiedPhotons = 1u << 21;

struct KeyValue {
    uint key;
    uint value;
};

template <class Work> void onAllThreads(std::size_t count, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1u << 14),
                      [&](const auto& range) { work(range.begin(), range.end()); });
}

/// Copies photons in an order: by the arrange kernel, and by `host`, which moves the photons of a range of places.
template <class Host>
Measurement measureCopy(Gpu& gpu, const std::string& name, const std::string& against, const std::vector<uint>& order,
                        const Host& host) {
    const std::vector<Photon> photons(copiedPhotons);
    const Buffer<Photon> from(gpu, "bench photons", photons), to(gpu, "bench photons", copiedPhotons);
    const Buffer<uint> places(gpu, "bench order", order);
    const Kernel<ReorderPhotonsArgs> arrange(gpu, "reorder_photons");
    std::vector<Photon> arranged(copiedPhotons);
    const PairedSeconds times = measurePairs(
        [&] {
        return kernelSeconds(gpu, [&] {
            Recording recording(gpu);
            recording.run(arrange, copiedPhotons, {from, places, to, copiedPhotons});
            recording.submit();
        });
        },
        [&] {
        return wallSeconds([&] {
            onAllThreads(copiedPhotons,
                         [&](std::size_t begin, std::size_t end) { host(photons, arranged, begin, end); });
        });
    });
    return asRate(name, against, "B/s", 2.0 * sizeof(Photon) * copiedPhotons, times);
}

} // namespace

Measurement measureSort(Gpu& gpu) {
    std::mt19937 random(1);
    std::vector<uint> keys(pairCount), values(pairCount);
    std::vector<KeyValue> pairs(pairCount);
    std::iota(values.begin(), values.end(), 0);
    for (std::size_t i = 0; i < pairCount; i++) pairs[i] = {keys[i] = static_cast<uint>(random()), values[i]};

    Sort sort(gpu);
    sort.reserve(pairCount);
    const auto vkpm = [&] {
        sort.keys.upload(keys);
        sort.values.upload(values);
        Recording recording(gpu);
        sort.sort(recording, pairCount, 32);
        return kernelSeconds(gpu, [&] { recording.submit(); });
    };
    const auto byKey = [](const KeyValue& a, const KeyValue& b) { return a.key < b.key; };
    const auto yardstick = [&] {
        std::vector<KeyValue> unsorted = pairs;
        return wallSeconds([&] { std::stable_sort(std::execution::par, unsorted.begin(), unsorted.end(), byKey); });
    };
    return asTime("sort", "std::stable_sort", measurePairs(vkpm, yardstick));
}

std::vector<Measurement> measureCopies(Gpu& gpu) {
    std::vector<uint> order(copiedPhotons);
    std::iota(order.begin(), order.end(), 0);
    const auto copy = [](const auto& from, auto& to, std::size_t begin, std::size_t end) {
        std::memcpy(&to[begin], &from[begin], (end - begin) * sizeof(Photon));
    };
    const Measurement inOrder = measureCopy(gpu, "copy", "memcpy", order, copy);

    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const auto scattered = [&](const auto& from, auto& to, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i++) to[i] = from[order[i]];
    };
    return {inOrder, measureCopy(gpu, "random_copy", "loop in C++", order, scattered)};
}

} // namespace vkpm
