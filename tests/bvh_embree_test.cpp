/// The hierarchies of the shipped scenes against Embree as an independent oracle.
#include "bench/embree_scene.h"
#include "host_rays.h"
#include "scene/bvh.h"
#include "scene/scene.h"
#include <array>
#include <gtest/gtest.h>
#include <random>

namespace vkpm {
namespace {

TEST(Bvh, FindsWhatEmbreeFindsInShippedScenes) {
    std::mt19937 random{11};
    std::uniform_real_distribution<double> uniform;
    for (const char* name : {"box.json", "diffuse_box.json", "ring.json", "glass.json", "pool.json"}) {
        Scene scene = loadScene(std::filesystem::path{VKPM_SCENES} / name);
        scene.primitives.resize(scene.triangleCount);
        const Bvh bvh = buildBvh(scene.primitives, scene.triangleCount);
        const EmbreeScene embree{scene, RTC_SCENE_FLAG_ROBUST};
        const auto anywhere = [&] {
            const dvec3 where{uniform(random), uniform(random), uniform(random)};
            return dvec3{scene.bounds.low} + where * dvec3{scene.bounds.high - scene.bounds.low};
        };

        // Rays that graze an edge may go either way in float.
        int differences = 0, hits = 0;
        for (int i = 0; i < 10000; ++i) {
            const dvec3 origin{vec3{anywhere()}};
            const dvec3 direction{vec3{anywhere() - origin}};
            const double expected{embree.closest(vec3(origin), vec3(direction)).t};
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
