// Aiming photons at the bounding spheres of specular shapes (the projection map of Jensen & Christensen 1995).
#ifndef PROJECTION_MAP_GLSL
#define PROJECTION_MAP_GLSL
#include "common.glsl"
#include "directions.glsl"
#include "feature_checks.glsl"
#include "light.glsl"
#include "light_delta.glsl"
#include "lobes.glsl"
#include "sampling.glsl"
#include "shared_scene.h"

// Solid angle that a target gets: that of its cone, or for a point inside it the hemisphere, all directions if `all`.
float targetSolidAngle(Target target, vec3 point, bool all) {
    vec3 d = target.center - point;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius) return all ? 4.0 * PI : 2.0 * PI;
    return 2.0 * PI * coneHeight(target.radius, distance2);
}

// A photon's way from a light: its direction, and a point of it by which it is known, `anchor`: the point of the light
// or, where that is so far away that its rounding would count, one next to what the photon is aimed at.
struct Aim {
    vec3 anchor;
    vec3 direction;
    float weight; // the cosine law, or 1 / (4 pi) of a point, over the density with which the direction was chosen
    bool remote;  // whether the anchor is not the point of the light
};

// Points of lights without a size have no normal.
bool isBare(LightPoint point) { return hasDeltaLights && point.normal == vec3(0.0); }

// Density over solid angle with which a target sends a direction, times its solid angle; a direction that was
// sampled from the target is within its cone, whatever rounding says.
float targetDensity(Target target, LightPoint point, Aim aim, bool sampled) {
    vec3 d = target.center - point.position;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius)
        return isBare(point) ? 1.0 : 2.0 * max(0.0, dot(aim.direction, point.normal));
    vec3 f = target.center - aim.anchor;
    if (dot(f, f) > distance2) f = d;
    vec3 across = cross(f, aim.direction);
    return sampled || (dot(d, aim.direction) > 0.0 && dot(across, across) <= target.radius * target.radius) ? 1.0 : 0.0;
}

// Lights that are farther than this many radii of a target, and than two of all but far lights, are remote from it: at
// 32 a place on the target is rounded to 2e-6 of its size.
const float REMOTE = 32.0;

bool isRemote(DeviceScene scene, Target target, vec3 point, float distance2) {
    if (hasFarLights == 0u) return false;
    vec3 d = scene.near.center - point;
    return distance2 > REMOTE * REMOTE * target.radius * target.radius &&
           dot(d, d) > 4.0 * scene.near.radius * scene.near.radius;
}

// A direction uniform over the cone that a target fills. Of a remote light the anchor is the point of the way that is
// next to the target's centre.
Aim aimInCone(DeviceScene scene, Target target, vec3 point, vec3 d, float distance2, vec2 u) {
    vec3 cone = uniformCone(u, coneHeight(target.radius, distance2));
    vec3 axis = d * inversesqrt(distance2);
    Aim aim = Aim(point, toWorld(cone, axis), 1.0, isRemote(scene, target, point, distance2));
    if (aim.remote)
        aim.anchor = target.center + toWorld(sqrt(distance2) * vec3(cone.xy * cone.z, -dot(cone.xy, cone.xy)), axis);
    return aim;
}

// Where a remote photon enters the sphere about all but far lights, or where it passes that by.
vec3 entrance(Target sphere, Aim aim) {
    vec3 f = aim.anchor - sphere.center;
    float along = dot(f, aim.direction);
    vec3 across = f - along * aim.direction;
    return aim.anchor - (along + sqrt(max(0.0, sphere.radius * sphere.radius - dot(across, across)))) * aim.direction;
}

Aim aimAtTarget(DeviceScene scene, Target target, LightPoint point, vec2 u) {
    vec3 d = target.center - point.position;
    float distance2 = dot(d, d);
    if (distance2 <= target.radius * target.radius)
        return Aim(point.position, isBare(point) ? uniformSphere(u) : toWorld(cosineHemisphere(u), point.normal), 1.0,
                   false);
    return aimInCone(scene, target, point.position, d, distance2, u);
}

// From a light without a size: uniform over all directions, over the outer cone of a spot or, from afar, the cone of
// all that light falls upon.
Aim aimBare(DeviceScene scene, Light light, LightPoint point, vec2 u) {
    vec3 d = scene.lit.center - point.position;
    float distance2 = dot(d, d);
    bool far = hasFarLights != 0u && distance2 > 4.0 * scene.lit.radius * scene.lit.radius;
    float lit = coneHeight(scene.lit.radius, max(distance2, scene.lit.radius * scene.lit.radius));
    float height = hasSpots && isBeam(light) ? beamOf(light).height : 2.0;
    Aim aim = Aim(point.position, uniformSphere(u), 1.0, false);
    if (far && lit < height) {
        aim = aimInCone(scene, scene.lit, point.position, d, distance2, u);
        height = lit;
    } else if (hasSpots && isBeam(light)) {
        aim.direction = toWorld(uniformCone(u, height), beamOf(light).axis);
    }
    aim.weight = 0.5 * height;
    return aim;
}

// From a ball with a beam: a direction uniform over the outer cone, from a point of the disc that the ball fills as
// seen from there. `point` becomes that on the ball.
Aim aimBeam(Light light, inout LightPoint point, vec2 place, vec2 u) {
    Beam beam = beamOf(light);
    vec3 w = toWorld(uniformCone(u, beam.height), beam.axis);
    point.normal = toWorld(cosineHemisphere(place), w);
    point.position = light.a + light.u.x * point.normal;
    return Aim(point.position, w, 0.5 * beam.height, false);
}

// The way of a photon for the global map: by the cosine law or, from where it would hardly ever meet anything, uniform
// over the cone of all that light falls upon. The weight is 0 below the horizon.
Aim aimAtLit(DeviceScene scene, LightPoint point, vec2 u) {
    vec3 d = scene.lit.center - point.position;
    float distance2 = dot(d, d);
    bool far = distance2 > 4.0 * scene.lit.radius * scene.lit.radius;
    if (checksFeatures) require(scene, far, hasFarLights != 0u, id_hasFarLights);
    if (hasFarLights == 0u || !far) return Aim(point.position, toWorld(cosineHemisphere(u), point.normal), 1.0, false);
    Aim aim = aimInCone(scene, scene.lit, point.position, d, distance2, u);
    aim.weight = 2.0 * coneHeight(scene.lit.radius, distance2) * max(0.0, dot(aim.direction, point.normal));
    return aim;
}

// What a target's material sends on to others, or about as much: a coat that reflects little gets few photons.
float targetWeight(DeviceScene scene, uint target) {
    return hasLayered ? floatPtr(scene.targetWeights).at[target] : 1.0;
}

float targetShare(DeviceScene scene, uint target, vec3 point, bool all) {
    return targetWeight(scene, target) * targetSolidAngle(TargetPtr(scene.targets).at[target], point, all);
}

// Chooses a target in proportion to its solid angle and its weight, and a direction within it. The density is that of
// the mixture, so a direction covered by several targets counts once; the weight is 0 if it is below the horizon.
Aim aimAtTargets(DeviceScene scene, LightPoint point, vec2 u, float choice) {
    if (scene.targetCount == 0u) return Aim(point.position, point.normal, 0.0, false);
    bool all = isBare(point);
    float total = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++) total += targetShare(scene, i, point.position, all);
    uint chosen = 0u;
    float left = choice * total - targetShare(scene, 0u, point.position, all);
    while (left >= 0.0 && chosen + 1u < scene.targetCount) left -= targetShare(scene, ++chosen, point.position, all);

    Aim aim = aimAtTarget(scene, TargetPtr(scene.targets).at[chosen], point, u);
    float density = 0.0;
    for (uint i = 0u; i < scene.targetCount; i++)
        density += targetWeight(scene, i) * targetDensity(TargetPtr(scene.targets).at[i], point, aim, i == chosen);
    float cosine = dot(aim.direction, point.normal);
    aim.weight = all ? total / (4.0 * PI * density) : cosine > 0.0 ? cosine / PI * total / density : 0.0;
    return aim;
}

#endif
