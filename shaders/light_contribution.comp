// What lights bring to points that the eye sees: to each of some points, some lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "direct.glsl"
#include "random.glsl"
#include "shared_camera.h"
#include "shared_guide.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include "traverse.glsl"

ARGS(LightContributionArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    DeviceScene scene = args.scene.at[0];
    Split from = args.splits.at[i / args.lightsEach * args.stride];
    args.values.at[i] = 0.0;
    if (from.flags == NONE) return;
    Sampler s = pixelSampler(i, 0u, args.seed, SAMPLES_EYE);
    ShadowRay ray = sampleDirectOf(scene, LightPtr(scene.lights).at[i % scene.lightCount], 1.0, from.origin, from.from,
                                   from.normal, from.shading, from.bulge, from.throughput, 0u, sample2(s, 0u), false);
    if (luminance(ray.radiance) > 0.0 && !hidden(scene, ray)) args.values.at[i] = luminance(ray.radiance);
}
