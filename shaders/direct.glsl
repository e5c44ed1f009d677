// Direct light at a point of a diffuse surface.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL
#include "common.glsl"
#include "feature_checks.glsl"
#include "light_sampling.glsl"
#include "offset.glsl"
#include "shared_camera.h"
#include "shared_scene.h"
#include "terminator.glsl"

// A shadow ray to a point of a light that was chosen with a probability, and what it brings if nothing is in its way:
// the radiance that leaves the surface times `weight`, which is zero if the light cannot be seen at all. The ray starts
// at `origin`, on the side of `normal`, which is the geometric one.
ShadowRay sampleDirectOf(Light light, float probability, vec3 origin, uint from, vec3 normal, vec3 shading, float bulge,
                         vec3 weight, uint column, vec2 place) {
    LightSample seen = sampleLight(light, origin, place);
    vec3 w = normalize(seen.point.position - origin);
    float cosine = cosineOfArrival(w, normal, shading, bulge);
    vec3 radiance =
        emittedRadiance(light, seen.point.normal, -w) * (cosine * seen.inversePdf / (PI * probability)) * weight;
    vec3 lightSide = dot(w, seen.point.normal) > 0.0 ? -seen.point.normal : seen.point.normal;
    return ShadowRay(origin, from, offsetPoint(seen.point.position, seen.point.magnitude, lightSide), radiance, column,
                     uint(goesThrough(w, normal, bulge)));
}

// That of a light chosen for light samples.
ShadowRay sampleDirect(DeviceScene scene, vec3 origin, uint from, vec3 normal, vec3 shading, float bulge, vec3 weight,
                       uint column, vec2 choice, vec2 place) {
    uint chosen = chooseLight(scene, scene.directCdf, choice.x);
    Light light = LightPtr(scene.lights).at[chosen];
    requireLight(scene, light);
    return sampleDirectOf(light, lightProbability(scene.directCdf, chosen), origin, from, normal, shading, bulge,
                          weight, column, place);
}

#endif
