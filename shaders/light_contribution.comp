// What lights bring to points that the eye sees: to each of some points, some lights, or one by some samples.
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
    uint point = i / args.each;
    bool inTurn = args.light == NONE;
    Sampler s = inTurn ? pixelSampler(i, 0u, args.seed, SAMPLES_EYE)
                       : pixelSampler(point, i % args.each, args.seed, SAMPLES_GATHER);
    vec2 u = sample2(s, 0u);
    args.values.at[i] = LightContribution(u, 0.0);
    Split from = args.splits.at[point * args.stride];
    if (from.flags == NONE) return;
    LightGuide guide = UNGUIDED;
    if (args.guided != 0u) guide = lightGuideAt(scene, from.origin);
    ShadowRay ray = sampleDirectOf(scene, LightPtr(scene.lights).at[inTurn ? i % scene.lightCount : args.light], 1.0,
                                   guide, from.origin, from.from, from.normal, from.shading, from.bulge,
                                   inTurn ? from.throughput : vec3(1.0), 0u, u, false);
    if (luminance(ray.radiance) > 0.0 && !hidden(scene, ray)) args.values.at[i].value = luminance(ray.radiance);
}
