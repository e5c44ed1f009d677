// Direct light at a point of a surface.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL
#include "common.glsl"
#include "feature_checks.glsl"
#include "light_guide.glsl"
#include "light_view.glsl"
#include "material.glsl"
#include "media.glsl"
#include "offset.glsl"
#include "shared_camera.h"
#include "shared_scene.h"
#include "terminator.glsl"

// The weight of a light sample that the lobe's own samples, of a density, would find as well, and of theirs (the
// balance heuristic of Veach & Guibas 1995): the light sample stands for the solid angle `inversePdf`, its choice
// included.
float lightSampleWeight(float inversePdf, float pdf) { return 1.0 / (1.0 + pdf * inversePdf); }

float lobeSampleWeight(float inversePdf, float pdf) {
    float x = pdf * inversePdf;
    return x < GREATEST ? x / (1.0 + x) : 1.0;
}

// A shadow ray to a point of a light that was chosen with a probability, and what it brings if nothing is in its way:
// the radiance that leaves the surface times `weight`, which is zero if the light cannot be seen at all. The ray starts
// at `origin`, on the side of `normal`, which is the geometric one. If `alsoFound`, a ray by the cosine law finds
// lights that are endlessly far as well, but for one that goes through a smooth mesh.
ShadowRay sampleDirectOf(DeviceScene scene, Light light, float probability, LightGuide guide, vec3 origin, uint from,
                         vec3 normal, vec3 shading, float bulge, vec3 weight, uint column, vec2 place, bool alsoFound) {
    LightView seen = viewGuided(scene, light, guide, origin, place);
    vec3 w = seen.w;
    float arrival = cosineOfArrival(w, normal, shading, bulge);
    float cosine = arrival;
    if (hasLayered)
        cosine = weightOfArrival(scene, materialNear(scene, from, origin, SLOT_METALLIC), w, normal, shading, bulge);
    if (hasEndless && alsoFound && (seen.flags & SHADOW_ENDLESS) != 0u && !goesThrough(w, normal, bulge))
        cosine *= lightSampleWeight(seen.inversePdf / probability, unpackPdf(packPdf(arrival / PI)));
    vec3 radiance = seen.radiance * (cosine * seen.inversePdf / (PI * probability)) * weight;
    uint flags = seen.flags | (goesThrough(w, normal, bulge) ? SHADOW_THROUGH : 0u);
    return ShadowRay(origin, from, seen.target, radiance, column, flags);
}

// That of a light chosen for light samples.
ShadowRay sampleDirect(DeviceScene scene, vec3 origin, uint from, vec3 normal, vec3 shading, float bulge, vec3 weight,
                       uint column, vec2 choice, vec2 place, LightGuide guide, bool alsoFound) {
    uint chosen = chooseLight(scene, scene.directCdf, guide.lights, choice.x);
    Light light = LightPtr(scene.lights).at[chosen];
    requireLight(scene, light);
    return sampleDirectOf(scene, light, lightProbability(scene.directCdf, guide.lights, chosen), guide, origin, from,
                          normal, shading, bulge, weight, column, place, alsoFound);
}

// That of a glossy lobe, in place of the cosine law. Where a light lies beyond a rough interface `at`, it is seen by
// refraction, and `goesBeyond` is set.
ShadowRay sampleDirectGlossy(DeviceScene scene, Surface surface, Material material, Interface at, vec3 wo, vec3 weight,
                             uint column, vec2 choice, vec2 place, out bool goesBeyond) {
    bool leaving = dot(wo, surface.normal) < 0.0;
    vec3 normal = leaving ? -surface.normal : surface.normal;
    vec3 origin = offsetPoint(surface.position, surface.magnitude, normal);
    uint chosen = chooseLight(scene, scene.directCdf, 0u, choice.x);
    Light light = LightPtr(scene.lights).at[chosen];
    requireLight(scene, light);
    LightView seen = viewLight(scene, light, origin, place);
    goesBeyond = isRoughGlass(material) && dot(seen.w, normal) < 0.0;
    if (goesBeyond) {
        origin = hasTouching ? leaveInterface(scene, surface, at, -normal)
                             : offsetPoint(surface.position, surface.magnitude, -normal);
        seen = viewLight(scene, light, origin, place);
    }
    vec3 w = seen.w;
    float inversePdf = seen.inversePdf / lightProbability(scene.directCdf, 0u, chosen);
    vec3 radiance = vec3(0.0);
    float pdf = 0.0;
    vec3 value = vec3(0.0);
    if (goesBeyond) {
        if (dot(w, normal) < 0.0) value = evaluateBeyond(material, surface, -wo, w, pdf);
        if (pdf == 0.0 && seen.isFound) value = vec3(0.0); // rays have it all
    } else if (dot(w, normal) > 0.0) {
        value = evaluateGlossyAt(material, surface, -wo, w, pdf);
    }
    pdf = seen.isFound ? unpackPdf(packPdf(pdf)) : 0.0;
    if (maxComponent(value) > 0.0)
        radiance = seen.radiance * value * weight * (inversePdf * lightSampleWeight(inversePdf, pdf));
    return ShadowRay(origin, surface.primitive, seen.target, radiance, column, seen.flags);
}

// The weight of a light that a ray from `origin` runs into, of what its last event, of density `pdf`, brings.
float weightOfLightFound(DeviceScene scene, uint index, Light light, vec3 origin, Surface surface, float pdf) {
    if (pdf == 0.0) return 1.0;
    LightPoint point = LightPoint(surface.position, surface.magnitude, surface.normal);
    float probability = lightProbability(scene.directCdf, 0u, index);
    return lobeSampleWeight(inversePdfOfLight(light, origin, point) / probability, pdf);
}

// What a ray from `origin` that leaves the scene in a direction finds of the lights that are endlessly far, with the
// weights of the event that sent it.
vec3 radianceBeyond(DeviceScene scene, LightGuide guide, vec3 w, float pdf) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < scene.endlessCount; i++) {
        Light light = LightPtr(scene.lights).at[i];
        SkyPoint point = endlessAt(scene, light, w);
        float inversePdf = point.inversePdf / lightProbability(scene.directCdf, guide.lights, i);
        if (guidesLight(guide, light)) inversePdf *= inverseDensityOfGuide(scene, guide, numbersOfSky(scene, w));
        sum += point.radiance * (pdf == 0.0 ? 1.0 : lobeSampleWeight(inversePdf, pdf));
    }
    return sum;
}

#endif
