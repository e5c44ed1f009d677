/// The same bits whatever runs how: driver threads, lanes, sizes of batches, repetitions.
#include "output/exr.h"
#include "program.h"
#include "render_support.h"
#include "shared_camera.h"
#include "shared_layers.h"
#include <cstring>
#include <fmt/format.h>

namespace vkpm {
namespace {

class Determinism : public Program {
protected:
    // All channels of a scene by an integrator under an environment, and the device that it says.
    Image renderWith(const std::string& integrator, const std::string& environment,
                     const std::string& name = "box") const {
        const Result result = run("--integrator " + integrator + " --scene " + scene(name) +
                                      " --size 40x32 --passes 3 --photons 5000 --caustic-photons 5000 --quiet -o x.exr",
                                  environment);
        EXPECT_EQ(result.code, 0) << result.output;
        return readExr(folder / "x.exr");
    }
};

void expectSameBits(const Image& a, const Image& b, const std::string& what) {
    ASSERT_EQ(a.channels.size(), b.channels.size()) << what;
    for (std::size_t i = 0; i < a.channels.size(); i++) {
        const auto& [name, values, storage] = a.channels[i];
        ASSERT_EQ(values.size(), b.channels[i].values.size());
        EXPECT_EQ(std::memcmp(values.data(), b.channels[i].values.data(), values.size() * sizeof(float)), 0)
            << what << ", " << name;
    }
}

TEST_F(Determinism, DriverThreadsAndLanesDoNotMatter) {
    for (const std::string integrator : {"photon", "light"}) {
        const Image plain = renderWith(integrator, "");
        expectSameBits(renderWith(integrator, ""), plain, integrator + ", another run");
        if (plain.attributes.at("device").find("llvmpipe") == std::string::npos)
            continue; // others have no such variables
        for (const int threads : {1, 2, 3})
            expectSameBits(renderWith(integrator, fmt::format("LP_NUM_THREADS={}", threads)), plain,
                           fmt::format("{}, {} threads", integrator, threads));

        for (const int bits : {128, 256, 512}) {
            const Image lanes = renderWith(integrator, fmt::format("LP_NATIVE_VECTOR_WIDTH={}", bits));
            EXPECT_NE(lanes.attributes.at("device").find(fmt::format("{} bits", bits)), std::string::npos)
                << lanes.attributes.at("device");
            expectSameBits(lanes, plain, fmt::format("{}, {} lanes", integrator, bits / 32));
        }
    }
}

// The pool's photons are guided by what the host learns from those of the device.
TEST_F(Determinism, GuidesAreTheSameOnAnyLanes) {
    const Image plain = renderWith("photon", "", "pool");
    for (const std::string environment :
         {"LP_NUM_THREADS=1", "LP_NUM_THREADS=2", "LP_NATIVE_VECTOR_WIDTH=128", "LP_NATIVE_VECTOR_WIDTH=512"})
        expectSameBits(renderWith("photon", environment, "pool"), plain, environment);
}

std::vector<Pixel> renderInBatches(const Scene& scene, uint integrator, BatchSizes batches, uint pixelSamples) {
    Settings settings = scene.settings;
    settings.integrator = integrator;
    settings.size = {40, 40}; // more than a band of rows that share
    settings.pixelSamples = pixelSamples;
    settings.photons = settings.causticPhotons = 3000;
    Renderer renderer(testGpu(), scene, settings, batches);
    for (const uint pass : {0u, 1u}) renderer.renderPass(pass);
    return renderer.film.download();
}

TEST(Batches, SizesDoNotMatter) {
    for (const char* name : {"box", "ring", "pool"})
        for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_LIGHT}) {
            const Scene scene = shippedScene(name);
            const uint paths = name == std::string("ring") ? MAX_LANES + 3 : scene.settings.pixelSamples;
            const std::vector<Pixel> whole = renderInBatches(scene, integrator, {}, paths);
            if (integrator == INTEGRATOR_PHOTON) {
                EXPECT_GT(layerMean(whole, LAYER_CAUSTIC) + layerMean(whole, LAYER_SPECULAR), 0);
            }
            for (const BatchSizes batches :
                 {BatchSizes{1u << 16, 100, 2}, {1000, 1u << 16}, {64, 1280, 1}, {2999, 1279}, {777, 333}}) {
                const std::vector<Pixel> parts = renderInBatches(scene, integrator, batches, paths);
                EXPECT_EQ(std::memcmp(parts.data(), whole.data(), whole.size() * sizeof(Pixel)), 0)
                    << name << ", integrator " << integrator << ", batches of " << batches.photons << " photons and "
                    << batches.camera << " paths, at first " << batches.rounds << " rounds";
            }
        }
}

} // namespace
} // namespace vkpm
