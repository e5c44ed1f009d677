// Starts photons on the lights: over the hemisphere or, of far lights, aimed at the scene; for the caustic map, aimed
// at the bounding spheres of specular shapes. Those of lights that are remote start where they enter the scene, if no
// other far light hides them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "compaction.glsl"
#include "feature_checks.glsl"
#include "guide.glsl"
#include "light_sampling.glsl"
#include "offset.glsl"
#include "projection_map.glsl"
#include "random.glsl"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include "traverse.glsl"

ARGS(EmitArgs)

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    DeviceScene scene = args.scene.at[0];
    Sampler s = photonSampler(args.firstPhoton + slot, args.pass, args.seed, args.caustic);

    float numbers[PRIMARY_DIMENSIONS] = primarySample(s);
    float inverseDensity = 1.0;
    if (hasGuide && args.guide != uvec2(0u)) inverseDensity = guide(GuideNodePtr(args.guide), numbers);

    // A light in proportion to its flux, a point on it, and the side if there are two.
    Light light = LightPtr(scene.lights).at[chooseLight(scene, scene.lightCdf, numbers[PRIMARY_LIGHT])];
    requireLight(scene, light);
    LightPoint point = sampleEmissionPoint(light, vec2(numbers[PRIMARY_POSITION], numbers[PRIMARY_POSITION + 1u]));
    if (isTwoSided(light) && numbers[PRIMARY_SIDE] < 0.5) point.normal = -point.normal;

    // A direction, and the weight that makes up for a density other than cos / pi.
    vec2 u = vec2(numbers[PRIMARY_DIRECTION], numbers[PRIMARY_DIRECTION + 1u]);
    Aim aim;
    if (args.caustic != 0u) aim = aimAtTargets(scene, point, u, numbers[PRIMARY_TARGET]);
    else aim = aimAtLit(scene, point, u);
    vec3 origin = offsetPoint(point.position, point.magnitude, point.normal);
    if (aim.remote) {
        vec3 entered = entrance(scene.near, aim);
        if (hasFarLights > 1u && aim.weight > 0.0 && occluded(scene, entered, origin, NONE)) aim.weight = 0.0;
        origin = entered;
    }
    float weight = aim.weight;
    if (hasGuide && args.starts != uvec2(0u))
        PrimarySamplePtr(args.starts).at[slot] = PrimarySample(numbers, weight, inverseDensity, 0u, 0u, vec3(0.0));
    weight *= inverseDensity;

    vec3 radiance = light.radiance;
    if (hasEmissionTextures && light.texture != 0u) radiance = texturedRadiance(scene, light, point.position);
    vec3 color = radiance / luminance(light.radiance) * (weight * light.share);
    args.paths.at[slot] = Path(origin, aim.direction, color, 0.0, NONE, 0u);
    args.list.at[slot] = slot;
    args.counts.at[slot] = 0u;
    putFlags(args.flags, slot, PHOTON_QUEUES, weight > 0.0 ? 1u << QUEUE_CONTINUE : 0u);
    if (!(weight > 0.0)) atomicAdd(args.status.at[0].escaped, 1u);
}
