// Direct light at a point of a surface.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL
#include "common.glsl"
#include "feature_checks.glsl"
#include "light_sampling.glsl"
#include "material.glsl"
#include "offset.glsl"
#include "shared_camera.h"
#include "shared_scene.h"
#include "terminator.glsl"

// A shadow ray to a point of a light that was chosen with a probability, and what it brings if nothing is in its way:
// the radiance that leaves the surface times `weight`, which is zero if the light cannot be seen at all. The ray starts
// at `origin`, on the side of `normal`, which is the geometric one.
ShadowRay sampleDirectOf(DeviceScene scene, Light light, float probability, vec3 origin, uint from, vec3 normal,
                         vec3 shading, float bulge, vec3 weight, uint column, vec2 place) {
    LightSample seen = sampleLight(light, origin, place);
    vec3 w = normalize(seen.point.position - origin);
    float cosine = cosineOfArrival(w, normal, shading, bulge) * diffuseArrivalAt(scene, from, origin, dot(w, shading));
    vec3 radiance =
        emittedRadianceAt(scene, light, seen.point, -w) * (cosine * seen.inversePdf / (PI * probability)) * weight;
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
    return sampleDirectOf(scene, light, lightProbability(scene.directCdf, chosen), origin, from, normal, shading, bulge,
                          weight, column, place);
}

// The weight of a light sample that the lobe's own samples, of a density, would find as well, and of theirs (the
// balance heuristic of Veach & Guibas 1995): the light sample stands for the solid angle `inversePdf`, its choice
// included.
float lightSampleWeight(float inversePdf, float pdf) { return 1.0 / (1.0 + pdf * inversePdf); }

float lobeSampleWeight(float inversePdf, float pdf) {
    float x = pdf * inversePdf;
    return x < GREATEST ? x / (1.0 + x) : 1.0;
}

// That of a glossy lobe about n, in place of the cosine law.
ShadowRay sampleDirectGlossy(DeviceScene scene, Surface surface, Material material, vec3 n, vec3 wo, vec3 weight,
                             uint column, vec2 choice, vec2 place) {
    bool leaving = dot(wo, surface.normal) < 0.0;
    vec3 normal = leaving ? -surface.normal : surface.normal;
    vec3 origin = offsetPoint(surface.position, surface.magnitude, normal);
    uint chosen = chooseLight(scene, scene.directCdf, choice.x);
    Light light = LightPtr(scene.lights).at[chosen];
    requireLight(scene, light);
    LightSample seen = sampleLight(light, origin, place);
    vec3 w = normalize(seen.point.position - origin);
    float inversePdf = seen.inversePdf / lightProbability(scene.directCdf, chosen);
    vec3 radiance = vec3(0.0);
    if (dot(w, normal) > 0.0 && dot(w, n) > 0.0 && dot(wo, n) > 0.0) {
        float pdf = unpackPdf(packPdf(pdfGlossy(material, leaving, n, wo, w)));
        radiance = emittedRadianceAt(scene, light, seen.point, -w) * evaluateGlossy(material, leaving, n, wo, w) *
                   weight * (inversePdf * lightSampleWeight(inversePdf, pdf));
    }
    vec3 lightSide = dot(w, seen.point.normal) > 0.0 ? -seen.point.normal : seen.point.normal;
    return ShadowRay(origin, surface.primitive, offsetPoint(seen.point.position, seen.point.magnitude, lightSide),
                     radiance, column, 0u);
}

// The weight of a light that a ray from `origin` runs into, of what its last event, of density `pdf`, brings.
float weightOfLightFound(DeviceScene scene, uint index, Light light, vec3 origin, Surface surface, float pdf) {
    if (pdf == 0.0) return 1.0;
    LightPoint point = LightPoint(surface.position, surface.magnitude, surface.normal);
    return lobeSampleWeight(inversePdfOfLight(light, origin, point) / lightProbability(scene.directCdf, index), pdf);
}

#endif
