// Ways of photons that come from endlessly far: a direction first, then a point of discs across it: of that about all
// that light falls upon, or those about the targets of caustics.
#ifndef AIM_FROM_AFAR_GLSL
#define AIM_FROM_AFAR_GLSL
#include "directions.glsl"
#include "light_endless.glsl"
#include "projection_map.glsl"
#include "sampling.glsl"
#include "shared_photons.h"

vec3 pointOfDisc(Target target, vec3 w, vec2 u) {
    return target.center + target.radius * toWorld(vec3(uniformDisc(u), 0.0), w);
}

float discArea(DeviceScene scene, uint target) {
    float radius = TargetPtr(scene.targets).at[target].radius;
    return targetWeight(scene, target) * radius * radius;
}

// Sum of the weights of the targets whose discs hold a point.
float discsAt(DeviceScene scene, Aim aim, uint chosen) {
    float sum = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++) {
        Target target = TargetPtr(scene.targets).at[i];
        vec3 across = cross(aim.anchor - target.center, aim.direction);
        if (i == chosen || dot(across, across) <= target.radius * target.radius) sum += targetWeight(scene, i);
    }
    return sum;
}

// Chooses a target by area and weight; what several cover counts once, as in aimAtTargets.
void aimAtDiscs(DeviceScene scene, vec2 u, float choice, inout Aim aim) {
    float total = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++) total += discArea(scene, i);
    uint chosen = 0u;
    float left = choice * total - discArea(scene, 0u);
    while (left >= 0.0 && chosen + 1u < scene.targetCount) left -= discArea(scene, ++chosen);
    aim.anchor = pointOfDisc(TargetPtr(scene.targets).at[chosen], aim.direction, u);
    aim.weight = total / (scene.lit.radius * scene.lit.radius * discsAt(scene, aim, chosen));
}

// About the middle of what is lit, of half of the photons, or about all: where the ground goes on to the horizon few of
// the others would come to where there is anything to see. The guide may change the halves.
void aimAtMiddle(DeviceScene scene, vec2 u, float choice, inout Aim aim) {
    bool middle = choice < 0.5;
    Target target = scene.lit;
    if (middle) target = scene.middle;
    aim.anchor = pointOfDisc(target, aim.direction, u);
    vec3 fromLit = cross(aim.anchor - scene.lit.center, aim.direction);
    vec3 fromMiddle = cross(aim.anchor - scene.middle.center, aim.direction);
    float lit2 = scene.lit.radius * scene.lit.radius, middle2 = scene.middle.radius * scene.middle.radius;
    float density = 0.0;
    if (!middle || dot(fromLit, fromLit) <= lit2) density += 0.5;
    if (middle || dot(fromMiddle, fromMiddle) <= middle2) density += 0.5 * (lit2 / middle2);
    aim.weight = 1.0 / density;
}

// The way of a photon by the numbers that start it; its colour is in `color`. The flux of such a light is what comes
// through the disc about all that is lit.
Aim aimFromAfar(DeviceScene scene, Light light, float numbers[PRIMARY_DIMENSIONS], bool caustic, out vec3 color) {
    SkyPoint point = sampleEndless(scene, light, vec2(numbers[PRIMARY_POSITION], numbers[PRIMARY_POSITION + 1u]));
    vec2 u = vec2(numbers[PRIMARY_DIRECTION], numbers[PRIMARY_DIRECTION + 1u]);
    Aim aim = Aim(vec3(0.0), -point.w, 1.0, true);
    if (caustic && scene.targetCount == 0u) aim.weight = 0.0;
    else if (caustic) aimAtDiscs(scene, u, numbers[PRIMARY_TARGET], aim);
    else if (scene.middle.radius > 0.0) aimAtMiddle(scene, u, numbers[PRIMARY_TARGET], aim);
    else aim.anchor = pointOfDisc(scene.lit, aim.direction, u);
    float fluxOfAll = PI * light.area * luminance(light.radiance);
    float disc = PI * scene.lit.radius * scene.lit.radius;
    color = point.radiance * (point.inversePdf * disc / fluxOfAll);
    return aim;
}

#endif
