/// The speed of gathers: the gather kernel beside a plain grid on the host, which must find the same.
#include "bench/gather.h"
#include "bench/whole_queue.h"
#include "gpu/recording.h"
#include "render/photon_grid.h"
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace vkpm {
namespace {

/// The octahedral code of a unit vector, as photons hold it.
uint packUnit(vec3 v) {
    vec2 p = vec2(v) / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
    if (v.z < 0) p = (1.0f - glm::abs(vec2(p.y, p.x))) * vec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1);
    const uvec2 q(glm::ivec2(glm::round(p * 32767.0f)) + 32767);
    return q.x | q.y << 16;
}

std::vector<Photon> packed(const std::vector<SurfacePoint>& points) {
    std::vector<Photon> photons;
    for (const SurfacePoint& point : points) photons.push_back({point.position, point.color, packUnit(point.normal)});
    return photons;
}

/// The gather kernel with all that it reads and writes.
class DeviceGather {
public:
    DeviceGather(Gpu& device, const BenchGathers& gathers)
        : gpu(device), photons(gpu, "bench photons", packed(gathers.photons)),
          queries(gpu, "bench queries", gathers.queries), samples(gpu, "bench samples", 3 * gathers.queries.size()),
          all(gpu, gathers.queries.size()), grid(gpu, "bench photons"),
          map(grid.build(photons, static_cast<uint>(photons.size()), gathers.radius, 1)),
          gather(gpu, "gather",
                 {.hasRadiusField = 0, .hasNearest = 0, .densityKernel = DENSITY_KERNEL_CONSTANT, .hasBias = 0}) {}

    void run() {
        Recording recording(gpu);
        recording.run(gather, queries.size(),
                      {map, queries, samples, all.queue, all.list, {}, static_cast<uint>(queries.size())});
        recording.submit();
    }

    /// Red, green and blue one after the other.
    std::vector<float> once() {
        Recording recording(gpu);
        recording.clear(samples);
        recording.submit();
        run();
        return samples.download();
    }

private:
    Gpu& gpu;
    Buffer<Photon> photons;
    Buffer<Query> queries;
    Buffer<float> samples;
    WholeQueue all;
    PhotonGrid grid;
    PhotonMap map;
    Kernel<GatherArgs> gather;
};

/// Rounding may move a photon at the rim of a disc in or out of it, in very few discs.
void requireSame(const std::vector<float>& ours, const std::vector<vec3>& theirs) {
    constexpr double tolerance = 1e-3;
    double sum = 0, otherSum = 0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < theirs.size(); i++) {
        const vec3 one{ours[i], ours[i + theirs.size()], ours[i + 2 * theirs.size()]}, other = theirs[i];
        const double apart = double(glm::length(one - other)), size = double(glm::length(other));
        if (!(apart <= tolerance * size)) different++;
        sum += double(one.x + one.y + one.z);
        otherSum += double(other.x + other.y + other.z);
    }
    const bool same = otherSum > 0 && std::abs(sum - otherSum) <= tolerance * otherSum;
    if (!same || different > theirs.size() / 10'000)
        throw std::runtime_error(
            fmt::format("bench: the gather kernel finds {:g} in all, the host {:g}; {} of {} queries differ", sum,
                        otherSum, different, theirs.size()));
}

} // namespace

Measurement measureGather(Gpu& gpu, const Scene& scene) {
    const BenchGathers gathers = makeGathers(scene);
    const std::size_t count = gathers.queries.size();
    DeviceGather device(gpu, gathers);
    const HostGrid grid(gathers.photons, gathers.radius);
    std::vector<vec3> found(count);
    const auto host = [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); i++) found[i] = grid.irradiance(gathers.queries[i]);
        });
    };
    host();
    requireSame(device.once(), found);
    const auto kernel = [&] { device.run(); };
    return asRate("gather", "grid in C++", "queries/s", double(count),
                  measurePairs([&] { return kernelSeconds(gpu, kernel); }, [&] { return wallSeconds(host); }));
}

} // namespace vkpm
