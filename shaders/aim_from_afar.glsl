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

// Of the discs about all that is lit: those about its middle, each four times as wide as the one before, the last about
// all.
Target litDisc(DeviceScene scene, uint index) {
    Target target = scene.lit;
    if (index + 1u < scene.discCount) {
        target = scene.middle;
        for (uint i = 0u; i < index; i++) target.radius *= 4.0;
    }
    return target;
}

// As many photons for each disc, so that there are fewer the farther from the middle, as there it is seen under smaller
// angles: where the ground goes on to the horizon few would else come to where there is anything to see.
void aimAtMiddle(DeviceScene scene, vec2 u, float choice, inout Aim aim) {
    uint chosen = min(uint(choice * float(scene.discCount)), scene.discCount - 1u);
    aim.anchor = pointOfDisc(litDisc(scene, chosen), aim.direction, u);
    float density = 0.0;
    for (uint i = 0u; i < scene.discCount; i++) {
        Target target = litDisc(scene, i);
        vec3 across = cross(aim.anchor - target.center, aim.direction);
        float part = scene.lit.radius / target.radius;
        if (i == chosen || dot(across, across) <= target.radius * target.radius) density += part * part;
    }
    aim.weight = float(scene.discCount) / density;
}

// The way of a photon by the numbers that start it; its colour is in `color`. The flux of such a light is what comes
// through the disc about all that is lit.
Aim aimFromAfar(DeviceScene scene, Light light, float numbers[PRIMARY_DIMENSIONS], bool caustic, out vec3 color) {
    SkyPoint point = sampleEndless(scene, light, vec2(numbers[PRIMARY_POSITION], numbers[PRIMARY_POSITION + 1u]));
    vec2 u = vec2(numbers[PRIMARY_DIRECTION], numbers[PRIMARY_DIRECTION + 1u]);
    Aim aim = Aim(vec3(0.0), -point.w, 1.0, true);
    if (caustic && scene.targetCount == 0u) aim.weight = 0.0;
    else if (caustic) aimAtDiscs(scene, u, numbers[PRIMARY_TARGET], aim);
    else if (scene.discCount > 1u) aimAtMiddle(scene, u, numbers[PRIMARY_TARGET], aim);
    else aim.anchor = pointOfDisc(scene.lit, aim.direction, u);
    float fluxOfAll = PI * light.area * luminance(light.radiance);
    float disc = PI * scene.lit.radius * scene.lit.radius;
    color = point.radiance * (point.inversePdf * disc / fluxOfAll);
    return aim;
}

#endif
