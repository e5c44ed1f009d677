/// The trace and shadow kernels against Embree in the shipped scenes; double precision judges where the two differ.
#include "bench/embree_scene.h"
#include "render/features.h"
#include "scene_on_device.h"
#include "scene_rays.h"
#include "shared_camera.h"
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

// A million rays; a twentieth where each costs twenty times as much: with asserts, under a sanitizer or a validation
// layer.
#ifdef NDEBUG
constexpr uint rayCount = 1'000'000;
#else
constexpr uint rayCount = 50'000;
#endif
constexpr uint largestCount = rayCount / 20; // of differences; rays aimed at edges and corners may go either way

// ---- The kernels --------------------------------------------------------------------------------

/// The nearest surface by geometry alone: what touches glass does not hide it.
Features withoutContact(const Scene& scene) {
    Features features = sceneFeatures(scene, scene.settings);
    features.hasContact = 0;
    return features;
}

/// A scene on the device, and queries through the kernels of a render.
class Device {
public:
    explicit Device(const Scene& scene)
        : uploaded(gpu, scene, Settings{.size = {16, 16}}), trace(gpu, "trace", withoutContact(scene)),
          shadow(gpu, "shadow", withoutContact(scene)) {}

    std::vector<Hit> closest(std::span<const TestRay> rays) {
        std::vector<Path> started;
        for (const TestRay& ray : rays) started.push_back({ray.origin, ray.direction, vec3{1}, 0, ray.from, 0});
        const Buffer<Path> paths(gpu, "paths", started);
        const Buffer<Hit> hits(gpu, "hits", rays.size());
        runAll(trace, rays.size(), [&](const auto& queue, const auto& list) {
            return TraceArgs{uploaded.address, paths, hits, queue, list};
        });
        return hits.download();
    }

    std::vector<bool> occluded(std::span<const TestRay> rays) {
        std::vector<ShadowRay> asked;
        for (const TestRay& ray : rays) asked.push_back({ray.origin, ray.from, ray.origin + ray.direction, vec3{1}, 0});
        const Buffer<ShadowRay> shadowRays(gpu, "shadow rays", asked);
        const Buffer<float> samples(gpu, "samples", std::vector<float>(3 * rays.size()));
        runAll(shadow, rays.size(), [&](const auto& queue, const auto& list) {
            return ShadowArgs{uploaded.address, shadowRays, samples, queue, list, static_cast<uint>(rays.size())};
        });
        std::vector<bool> result;
        for (const float red : samples.download(rays.size())) result.push_back(red == 0);
        return result;
    }

private:
    template <class Args, class Bind> void runAll(const Kernel<Args>& kernel, std::size_t count, const Bind& bind) {
        std::vector<uint> identity(count);
        std::iota(identity.begin(), identity.end(), 0);
        const Queue whole{.count = static_cast<uint>(count)};
        const Buffer<Queue> queue(gpu, "queue", std::span(&whole, 1));
        const Buffer<uint> list(gpu, "list", identity);
        Recording recording(gpu);
        recording.run(kernel, count, bind(queue, list));
        recording.submit();
    }

    Gpu& gpu = testGpu();
    UploadedScene uploaded;
    Kernel<TraceArgs> trace;
    Kernel<ShadowArgs> shadow;
};

// ---- The comparison -----------------------------------------------------------------------------

/// Where vkpm and Embree differ: who is right; both are, where rounding decides.
struct Differences {
    uint count = 0, random = 0, ties = 0, wrong = 0, wrongEmbree = 0; // random: of rays in general position
    double error = 0;

    bool tooMany() const { return wrong >= 100 || count >= largestCount; }
    void add(bool accepted, bool acceptedEmbree, uint ray) {
        ++count;
        wrong += !accepted;
        wrongEmbree += !acceptedEmbree;
        if (!accepted && wrong <= 3)
            ADD_FAILURE() << "ray " << ray << (acceptedEmbree ? ": Embree is right" : ": Embree is wrong too");
    }
};

void print(const std::string& what, const Differences& d) {
    std::printf("  %-14s differences %5u (%u of random rays), vkpm wrong %u, Embree wrong %4u; ties %6u; t off by %.2f "
                "of its bound\n",
                what.c_str(), d.count, d.random, d.wrong, d.wrongEmbree, d.ties, d.error);
}

/// The closest hit but for the triangle that the ray leaves, which Embree may report once more, near t = 0.
Hit embreeClosest(const Scene& scene, const EmbreeScene& embree, const TestRay& ray) {
    const Hit hit = embree.closest(ray.origin, ray.direction);
    if (hit.primitive != ray.from || hit.primitive >= scene.triangleCount) return hit;
    return embree.closest(ray.origin, ray.direction, hit.t * 1.0001f + 1e-6f);
}

Differences compareClosest(const Scene& scene, Device& device, const EmbreeScene& embree,
                           std::span<const TestRay> rays) {
    const Judge judge{scene};
    const std::vector<Hit> hits = device.closest(rays);
    Differences differences;
    for (uint i = 0; i < rays.size() && !differences.tooMany(); ++i) {
        const TestRay& ray = rays[i];
        const Hit expected = embreeClosest(scene, embree, ray), found = hits[i];
        if (found.primitive != NONE) differences.error = std::max(differences.error, judge.error(ray, found));
        if (found.primitive == NONE && expected.primitive == NONE) continue;
        if (found.primitive != NONE && expected.primitive != NONE &&
            std::abs(found.t - expected.t) <= judge.tolerance(ray, found) + judge.tolerance(ray, expected))
            differences.ties += found.primitive != expected.primitive;
        else {
            differences.random += RayMaker::isRandom(i);
            differences.add(judge.accepts(ray, found), judge.accepts(ray, expected), i);
        }
    }
    return differences;
}

Differences compareOccluded(const Scene& scene, Device& device, const EmbreeScene& embree,
                            std::span<const TestRay> rays) {
    const Judge judge{scene};
    const std::vector<bool> occluded = device.occluded(rays);
    Differences differences;
    for (uint i = 0; i < rays.size() && !differences.tooMany(); ++i) {
        const vec3 target = rays[i].origin + rays[i].direction;
        const TestRay rounded{rays[i].origin, target - rays[i].origin, rays[i].from};
        const bool expected = embree.occluded(rounded.origin, target) && embreeClosest(scene, embree, rounded).t < 1;
        if (occluded[i] != expected)
            differences.add(judge.accepts(rounded, occluded[i]), judge.accepts(rounded, expected), i);
    }
    return differences;
}

class Rays : public testing::TestWithParam<const char*> {
protected:
    Scene scene = loadScene(std::filesystem::path{VKPM_SCENES} / (std::string{GetParam()} + ".json"));
    EmbreeScene embree{scene, RTC_SCENE_FLAG_ROBUST};
    Device device{scene};
    RayMaker maker{scene};
};

TEST_P(Rays, HitWhatEmbreeHits) {
    const Differences found = compareClosest(scene, device, embree, maker.rays(rayCount));
    print(GetParam() + std::string{" closest"}, found);
    EXPECT_EQ(found.wrong, 0u);
    EXPECT_LE(found.error, 1.0);
    EXPECT_LE(found.random, 3u);
    EXPECT_LT(found.count, largestCount);
}

TEST_P(Rays, AreOccludedWhereEmbreeSaysSo) {
    const Differences found = compareOccluded(scene, device, embree, maker.segments(rayCount));
    print(GetParam() + std::string{" occluded"}, found);
    EXPECT_EQ(found.wrong, 0u);
    EXPECT_LT(found.count, rayCount / 200);
}

// A rectangle is two triangles in one plane: a ray leaves both.
TEST_P(Rays, LeaveTheirRectangle) {
    const std::vector<TestRay> rays = maker.leavingRectangles(rayCount / 4);
    ASSERT_FALSE(rays.empty());
    const std::vector<Hit> hits = device.closest(rays);
    uint same = 0;
    for (uint i = 0; i < rays.size(); ++i) same += hits[i].primitive / 2 == rays[i].from / 2;
    EXPECT_EQ(same, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Rays, testing::Values("ring", "glass", "pool", "box"),
                         [](const auto& scene) { return scene.param; });

} // namespace
} // namespace vkpm
