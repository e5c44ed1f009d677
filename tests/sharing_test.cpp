/// Gathers that neighbours share: who is a neighbour, what they make of noise, and how blurred it says it is.
#include "judge.h"
#include "map.h"
#include "shared_camera.h"
#include "shared_film.h"
#include "shared_layers.h"
#include "shared_scene.h"
#include <functional>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

const uvec2 size{64, 2 * SHARING_BAND};
const uint pixels = size.x * size.y;
const uint bandShift = 5;
const float spacing = 0.01f; // of points, which lie on a plane, as far apart as a pixel is wide

using Value = std::function<float(uint x, uint y)>;

/// A point seen by way of a mirror.
Split pointOf(uint x, uint y) {
    Split split{};
    split.origin = vec3{x, y, 0} * spacing;
    split.normal = split.shading = vec3{0, 0, 1};
    split.throughput = vec3{1};
    split.flags = PATH_EYE_SPECULAR | 1u << PATH_DIFFUSE_SHIFT;
    split.footprint = spacing;
    return split;
}

std::vector<Split> plane() {
    std::vector<Split> splits;
    for (uint i = 0; i < pixels; i++) splits.push_back(pointOf(i % size.x, i / size.x));
    return splits;
}

/// What each pixel has of the mean of its neighbours' values, and of its bias.
struct SharedValues {
    std::vector<float> mean, bias;
};

SharedValues share(const std::vector<Split>& splits, const Value& value, float radius, const Camera& camera = {}) {
    const Columns columns;
    std::vector<float> samples(columns.cameraColumns() * pixels);
    for (uint i = 0; i < pixels; i++) samples[columns.SAMPLE_COLUMNS * pixels + i] = value(i % size.x, i / size.x);
    DeviceScene scene{};
    scene.camera = camera;
    const Buffer<DeviceScene> sceneBuffer(testGpu(), "scene", std::vector{scene});
    const Buffer<Split> splitBuffer(testGpu(), "splits", splits);
    const Buffer<float> sampleBuffer(testGpu(), "samples", samples);
    const Kernel<ShareGathersArgs> kernel(testGpu(), "share_gathers");
    Recording recording(testGpu());
    recording.run(kernel, pixels,
                  {sceneBuffer, splitBuffer, sampleBuffer, pixels, pixels, 0, size.x, bandShift, 3, radius, 1});
    recording.submit();
    const std::vector<float> all = sampleBuffer.download();
    const auto column = [&](uint c) {
        return std::vector<float>(all.begin() + c * pixels, all.begin() + (c + 1) * pixels);
    };
    SharedValues shared{column(columns.COLUMN_SPECULAR), column(columns.COLUMN_BIAS)};
    for (uint i = 0; i < pixels; i++) // of what is seen directly
        shared.mean[i] += all[columns.COLUMN_INDIRECT * pixels + i];
    return shared;
}

// Points of six kinds in disorder, none of which may share with another, and neither may pixels of two bands: where all
// that do share have the same value, so has their mean (but for the rounding of its sum).
TEST(Sharing, IsBetweenNeighboursAlone) {
    const float radius = 6 * spacing;
    std::vector<Split> splits = plane();
    std::vector<uint> kinds(pixels);
    Random random(1);
    for (uint i = 0; i < pixels; i++) {
        Split& split = splits[i];
        kinds[i] = random.bits() % 6;
        if (kinds[i] == 1) split.shading.z = -1;                                // on the other side
        if (kinds[i] == 2) split.origin.z = 0.2f * radius;                      // off the plane
        if (kinds[i] == 3) split.flags ^= PATH_EYE_SPECULAR;                    // seen directly
        if (kinds[i] == 4) split.origin.x += 100;                               // far away
        if (kinds[i] == 5) split.shading = glm::normalize(vec3{0, 0.8f, 0.6f}); // at an angle
    }
    const Value value = [&](uint x, uint y) {
        return float(8 * kinds[y * size.x + x] + (y + bandShift) / SHARING_BAND + 1);
    };
    const Camera camera{.origin = {0.3f, 0.2f, 1}, .forward = {0, 0, -1}, .right = {1, 0, 0}, .up = {0, 1, 0}};
    const std::vector<float> means = share(splits, value, radius, camera).mean;
    for (uint i = 0; i < pixels; i++) {
        const float expected = value(i % size.x, i / size.x); // of another kind or band: by one at least
        ASSERT_NEAR(means[i], expected, 1e-6 * expected) << i << " of " << kinds[i];
    }
}

const double variance = 1.0 / 12; // of numbers uniform in [0, 1)

// What sharing leaves of that.
double varianceOfNoise(const std::vector<Split>& splits, float radius, const Camera& camera = {}) {
    Random random(2);
    std::vector<float> noise(pixels);
    for (float& value : noise) value = random.unit();
    const auto value = [&](uint x, uint y) { return noise[y * size.x + x]; };
    Mean mean, square;
    for (const float shared : share(splits, value, radius, camera).mean) {
        mean.add(shared);
        square.add((shared - 0.5) * (shared - 0.5));
    }
    EXPECT_NEAR(mean.mean(), 0.5, 0.02);
    return square.mean();
}

// Of independent values the variance falls by the number of neighbours: 49 are looked at in and around the disc, and
// bands cut it.
TEST(Sharing, TakesNoiseAway) {
    for (const float pixelsWide : {4.0f, 12.0f}) {
        EXPECT_LT(varianceOfNoise(plane(), pixelsWide * spacing), variance / 15) << pixelsWide;
        EXPECT_GT(varianceOfNoise(plane(), pixelsWide * spacing), variance / 60) << pixelsWide;
    }
}

// The mean of x^2 over a disc of radius r is r^2 / 4 more than in its middle.
TEST(Sharing, SaysHowBlurredItIs) {
    const float radius = 6.5f * spacing;
    const auto x2 = [](uint x, uint) { return float(x * x) * spacing * spacing; };
    const SharedValues shared = share(plane(), x2, radius);
    Mean blur, bias;
    for (uint i = 0; i < pixels; i++) {
        const uint x = i % size.x;
        if (x < 8 || x >= size.x - 8) continue;
        blur.add(shared.mean[i] - x2(x, 0));
        bias.add(shared.bias[i]);
    }
    EXPECT_NEAR(blur.mean(), 0.25 * radius * radius, 0.02 * radius * radius);
    EXPECT_NEAR(bias.mean(), blur.mean(), 0.1 * blur.mean());
}

// At an edge towards which light falls, neighbours lie to one side, off by 4 / (3 pi) of the radius in their mean.
TEST(Sharing, SaysHowBlurredEdgesAre) {
    const float radius = 12.5f * spacing;
    const SharedValues shared = share(
        plane(), [](uint x, uint) { return float(x) * spacing; }, radius);
    Mean blur, bias;
    for (uint i = 0; i < pixels; i += size.x) {
        blur.add(shared.mean[i]);
        bias.add(shared.bias[i]);
    }
    EXPECT_NEAR(blur.mean(), 4 / (3 * pi) * radius, 0.03 * radius);
    EXPECT_NEAR(bias.mean(), blur.mean(), 0.1 * blur.mean());
}

TEST(Sharing, WhatIsNotFiniteStaysAlone) {
    const uint bad = 10 * size.x + 30;
    const auto value = [](uint x, uint y) { return y * size.x + x == bad ? std::nanf("") : 1.0f; };
    const std::vector<float> means = share(plane(), value, 4 * spacing).mean;
    for (uint i = 0; i < pixels; i++) ASSERT_EQ(std::isfinite(means[i]), i != bad) << i;
}

// A plane that is seen at an angle from afar: a disc of six pixels to either side is less than two pixels high, and as
// many share as there are.
TEST(Sharing, KnowsHowDiscsAreSeen) {
    const float cosine = 0.25f, sine = std::sqrt(1 - cosine * cosine);
    std::vector<Split> splits = plane();
    for (Split& split : splits) {
        split.flags ^= PATH_EYE_SPECULAR;
        split.origin.y /= cosine;
    }
    Camera camera{.forward = {0, sine, -cosine}, .right = {1, 0, 0}, .up = {0, cosine, sine}};
    camera.origin = -1000.0f * camera.forward;
    EXPECT_LT(varianceOfNoise(splits, 6 * spacing, camera), variance / 15);
}

} // namespace
} // namespace vkpm
