/// A renderer that looks elsewhere, or was told to leave a pass, has the bits of a new one.
#include "render_support.h"
#include <cstring>
#include <gtest/gtest.h>
#include <thread>

namespace vkpm {
namespace {

const uvec2 size{40, 32};

Settings settingsFor(const Scene& scene, uint integrator) {
    Settings settings = scene.settings;
    settings.integrator = integrator;
    settings.size = size;
    settings.photons = settings.causticPhotons = 3000;
    return settings;
}

View elsewhere(const Scene& scene) {
    View view = scene.view;
    view.origin += vec3(0.3f, -0.2f, -0.4f);
    view.fieldOfView *= 1.1f;
    return view;
}

Rendered passesOf(Renderer& renderer, uint begin = 0, uint end = 3) {
    for (uint pass = begin; pass < end; pass++) renderer.renderPass(pass);
    return {renderer.film.download(), renderer.photons(MapKind::global), renderer.photons(MapKind::caustic)};
}

/// What a new renderer gives for a view and a size.
Rendered anew(Scene scene, const View& view, Settings settings, uvec2 pixels, uint passes = 3) {
    scene.view = view;
    settings.size = pixels;
    Renderer renderer(testGpu(), scene, settings);
    return passesOf(renderer, 0, passes);
}

void expectSame(const Rendered& a, const Rendered& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Pixel)), 0);
    EXPECT_EQ(a.global.emitted, b.global.emitted);
    EXPECT_EQ(a.caustic.stored, b.caustic.stored);
    EXPECT_EQ(a.caustic.rays, b.caustic.rays);
}

void expectAsIfNew(const Scene& scene) {
    for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH, INTEGRATOR_LIGHT, INTEGRATOR_PHOTON_MAP}) {
        const Settings settings = settingsFor(scene, integrator);
        Renderer renderer(testGpu(), scene, settings);
        passesOf(renderer);
        for (const uvec2 pixels : {size, uvec2(24, 48), size}) {
            renderer.setView(elsewhere(scene), pixels);
            EXPECT_EQ(renderer.film.passCount(), 0u);
            expectSame(passesOf(renderer), anew(scene, elsewhere(scene), settings, pixels));
        }
    }
}

TEST(Look, AnotherViewOrSizeIsAsIfNew) { expectAsIfNew(shippedScene("box")); }

TEST(Look, GuidesFollowTheView) {
    expectAsIfNew(ringCusp());

    // From a guide to none and back.
    const Scene near = ringCusp(), far = shippedScene("ring");
    const Settings settings = settingsFor(near, INTEGRATOR_PHOTON);
    Renderer renderer(testGpu(), near, settings);
    for (const Scene* scene : {&near, &far, &near}) {
        renderer.setView(scene->view, size);
        expectSame(passesOf(renderer), anew(near, scene->view, settings, size));
        EXPECT_EQ(renderer.features().hasGuide, scene == &near);
    }
}

// The flag comes up after another number of submissions each time, until all passes go through. Then the renderer looks
// elsewhere, or goes on with the pass that it left.
void expectAsIfNewAfterCancelled(const Scene& scene) {
    const uint passes = 8;
    uint left = 0, wentOn = 0;
    for (int microseconds = 300, run = 0; microseconds < 60'000; microseconds = microseconds * 4 / 3, run++) {
        const Settings settings = settingsFor(scene, run % 2 ? INTEGRATOR_LIGHT : INTEGRATOR_PHOTON);
        Renderer renderer(testGpu(), scene, settings, {.photons = 512, .camera = 300});
        renderer.renderPass(0);
        std::atomic<bool> cancel{false};
        testGpu().cancel = &cancel;
        std::jthread other([&] {
            std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
            cancel = true;
        });
        uint pass = 0;
        renderer.setView(scene.view, size);
        try {
            for (; pass < passes; pass++) renderer.renderPass(pass);
        } catch (const Cancelled&) {
            left++;
            wentOn += run % 4 < 2;
        }
        testGpu().cancel = nullptr;
        if (run % 4 < 2) {
            expectSame(passesOf(renderer, pass, passes), anew(scene, scene.view, settings, size, passes));
        } else {
            renderer.setView(elsewhere(scene), size);
            expectSame(passesOf(renderer), anew(scene, elsewhere(scene), settings, size));
        }
    }
    EXPECT_GT(left, 5u);
    EXPECT_GT(wentOn, 2u);
}

TEST(Look, AfterCancelledItIsAsIfNew) { expectAsIfNewAfterCancelled(shippedScene("box")); }

TEST(Look, AfterCancelledGuidesAreAsIfNew) { expectAsIfNewAfterCancelled(ringCusp()); }

} // namespace
} // namespace vkpm
