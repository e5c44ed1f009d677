// Starts photons on the lights: over the hemisphere or, of far lights, aimed at the scene; for the caustic map, aimed
// at the bounding spheres of specular shapes. Those of lights that are remote start where they enter the scene, if no
// other far light hides them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aim_from_afar.glsl"
#include "common.glsl"
#include "compaction.glsl"
#include "feature_checks.glsl"
#include "guide.glsl"
#include "light_sampling.glsl"
#include "offset.glsl"
#include "opacity.glsl"
#include "projection_map.glsl"
#include "random.glsl"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_scene.h"
#include "traverse.glsl"

ARGS(EmitArgs)

// Of paths that start before a light, or behind it.
uint mediaOfLight(DeviceScene scene, uint light, bool behind) {
    return hasMedia && scene.media != uvec2(0u) ? uintPtr(scene.lightMedia).at[2u * light + uint(behind)] : 0u;
}

bool startsBehind(Light light, float numbers[PRIMARY_DIMENSIONS]) {
    return isTwoSided(light) && numbers[PRIMARY_SIDE] < 0.5;
}

// A point on the light, and the side if there are two; then a direction, and the weight that makes up for a density
// other than cos / pi, or other than uniform from a point.
void startOnLight(DeviceScene scene, Light light, float numbers[PRIMARY_DIMENSIONS], out Aim aim, out vec3 origin,
                  out vec3 color) {
    vec2 place = vec2(numbers[PRIMARY_POSITION], numbers[PRIMARY_POSITION + 1u]);
    LightPoint point = sampleEmissionPoint(light, place);
    if (startsBehind(light, numbers)) point.normal = -point.normal;
    bool bare = hasDeltaLights && isDelta(light), beam = hasSpots && isBeam(light);
    if (bare) point = LightPoint(light.a, abs(light.a), vec3(0.0));

    vec2 u = vec2(numbers[PRIMARY_DIRECTION], numbers[PRIMARY_DIRECTION + 1u]);
    if (args.caustic != 0u) aim = aimAtTargets(scene, point, u, numbers[PRIMARY_TARGET]);
    else if (hasDeltaLights && bare) aim = aimBare(scene, light, point, u);
    else if (hasSpots && beam) aim = aimBeam(light, point, place, u);
    else aim = aimAtLit(scene, point, u);
    origin = offsetPoint(point.position, point.magnitude, point.normal);
    if (aim.remote) {
        vec3 entered = entrance(scene.near, aim);
        if (hasFarLights > 1u && aim.weight > 0.0 && occluded(scene, entered, origin, NONE)) aim.weight = 0.0;
        origin = entered;
    }
    // The area is flux over pi times radiance.
    if (bare) aim.weight *= 4.0 / light.area;
    else if (beam) aim.weight *= 4.0 * PI * light.u.x * light.u.x / light.area;
    if ((hasDeltaLights || hasSpots) && (bare || beam)) aim.weight *= partOfBeam(light, aim.direction);
    vec3 radiance = light.radiance;
    if (hasEmissionTextures && light.texture != 0u) radiance = texturedRadiance(scene, light, point.position);
    color = radiance / luminance(light.radiance);
    if (hasOpacity && !bare) color *= opacityOfLight(scene, light, point.position);
}

// The same of a light that is endlessly far: photons start where they enter the scene, unless a far light hides it.
void startAfar(DeviceScene scene, Light light, float numbers[PRIMARY_DIMENSIONS], out Aim aim, out vec3 origin,
               out vec3 color) {
    aim = aimFromAfar(scene, light, numbers, args.caustic != 0u, color);
    origin = entrance(scene.near, aim);
    if (hasFarLights > 0u && closest(scene, origin, -aim.direction, NONE).primitive != NONE) aim.weight = 0.0;
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    DeviceScene scene = args.scene.at[0];
    Sampler s = photonSampler(args.firstPhoton + slot, args.pass, args.seed, args.caustic);

    float numbers[PRIMARY_DIMENSIONS] = primarySample(s);
    float inverseDensity = 1.0;
    if (hasGuide && args.guide != uvec2(0u)) inverseDensity = guide(GuideNodePtr(args.guide), numbers);

    // A light in proportion to its flux.
    uint chosen = chooseLight(scene, scene.lightCdf, 0u, numbers[PRIMARY_LIGHT]);
    Light light = LightPtr(scene.lights).at[chosen];
    requireLight(scene, light);
    vec3 color;
    vec3 origin;
    Aim aim;
    if (hasEndless && isEndless(light)) startAfar(scene, light, numbers, aim, origin, color);
    else startOnLight(scene, light, numbers, aim, origin, color);
    float weight = aim.weight;
    if (hasGuide && args.starts != uvec2(0u))
        PrimarySamplePtr(args.starts).at[slot] = PrimarySample(numbers, weight, inverseDensity, 0u, 0u, vec3(0.0));
    weight *= inverseDensity;

    args.paths.at[slot] = Path(origin, aim.direction, color * (weight * light.share), 0.0, NONE, 0u,
                               mediaOfLight(scene, chosen, startsBehind(light, numbers)));
    args.list.at[slot] = slot;
    args.counts.at[slot] = 0u;
    putFlags(args.flags, slot, PHOTON_QUEUES, weight > 0.0 ? 1u << QUEUE_CONTINUE : 0u);
    if (!(weight > 0.0)) atomicAdd(args.status.at[0].escaped, 1u);
}
