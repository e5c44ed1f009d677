/// The hierarchies of the shipped scenes against Embree as an independent oracle.
#include "host_rays.h"
#include "scene/bvh.h"
#include "scene/scene.h"
#include <array>
#include <embree3/rtcore.h>
#include <gtest/gtest.h>
#include <random>

namespace vkpm {
namespace {

/// An Embree scene of the triangles of ours.
struct EmbreeScene {
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);

    explicit EmbreeScene(const Scene& source) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* points = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * source.triangleCount));
        auto* corners = static_cast<uint*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint), source.triangleCount));
        for (uint i = 0; i < source.triangleCount; ++i) {
            const Primitive& p = source.primitives[i];
            for (uint k = 0; k < 3; ++k) {
                points[3 * i + k] = std::array{p.a, p.b, p.c}[k];
                corners[3 * i + k] = 3 * i + k;
            }
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    double closest(dvec3 origin, dvec3 direction) const {
        const vec3 o{origin}, d{direction};
        RTCRayHit ray{};
        ray.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, std::numeric_limits<float>::infinity(), 0xffffffffu, 0, 0};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &ray);
        return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : double{ray.ray.tfar};
    }
};

TEST(Bvh, FindsWhatEmbreeFindsInShippedScenes) {
    std::mt19937 random{11};
    std::uniform_real_distribution<double> uniform;
    for (const char* name : {"box.json", "diffuse_box.json", "ring.json", "glass.json", "pool.json"}) {
        const Scene scene = loadScene(std::filesystem::path{VKPM_SCENES} / name);
        const std::vector<Primitive> triangles(scene.primitives.begin(),
                                               scene.primitives.begin() + scene.triangleCount);
        const Bvh bvh = buildBvh(triangles, scene.triangleCount);
        const EmbreeScene embree{scene};
        const auto anywhere = [&] {
            const dvec3 where{uniform(random), uniform(random), uniform(random)};
            return dvec3{scene.bounds.low} + where * dvec3{scene.bounds.high - scene.bounds.low};
        };

        // Rays that graze an edge may go either way in float.
        int differences = 0, hits = 0;
        for (int i = 0; i < 10000; ++i) {
            const dvec3 origin{vec3{anywhere()}};
            const dvec3 direction{vec3{anywhere() - origin}};
            const double expected = embree.closest(origin, direction);
            const double found = closestByTree(bvh, scene.triangleCount, origin, direction).t;
            hits += found < infinity;
            differences += found != expected && !(std::abs(found - expected) <= 1e-4 * std::max(1.0, expected));
        }
        EXPECT_GT(hits, 5000) << name;
        EXPECT_LE(differences, 3) << name;
    }
}

} // namespace
} // namespace vkpm
