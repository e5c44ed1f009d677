// Area lights: which one, and how much it sends.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
#include "common.glsl"
#include "light_beam.glsl"
#include "shared_scene.h"
#include "texture.glsl"

struct LightPoint {
    vec3 position;
    vec3 magnitude; // as in Surface
    vec3 normal;
};

// A point of a light, and the solid angle that it stands for where it is seen from: one over the density over solid
// angle.
struct LightSample {
    LightPoint point;
    float inversePdf;
};

// The solid angle that a point stands for among points that are uniform over the area of the light.
float inversePdfByArea(Light light, vec3 normal, vec3 toLight) {
    float distance2 = dot(toLight, toLight);
    return light.area * abs(dot(toLight, normal)) * inversesqrt(distance2) / distance2;
}

// The sample of a point that was chosen uniformly over the area of the light.
LightSample sampleByArea(Light light, LightPoint point, vec3 origin) {
    return LightSample(point, inversePdfByArea(light, point.normal, point.position - origin));
}

// The light whose part of the unit interval holds u, by upper ends from the `first` number on.
uint chooseLight(DeviceScene scene, uvec2 cdf, uint first, float u) {
    if (!hasManyLights) return 0u;
    return firstAbove(cdf, first, 1u, scene.lightCount, u);
}

// The probability of being chosen.
float lightProbability(uvec2 cdf, uint first, uint light) {
    if (!hasManyLights) return 1.0;
    return floatPtr(cdf).at[first + light] - (light > 0u ? floatPtr(cdf).at[first + light - 1u] : 0.0);
}

bool isTwoSided(Light light) { return hasTwoSidedLights && light.twoSided != 0u; }

// Radiance that a light sends in direction w from where its normal is n.
vec3 emittedRadiance(Light light, vec3 n, vec3 w) {
    if (!isTwoSided(light) && dot(n, w) <= 0.0) return vec3(0.0);
    return hasSpots ? light.radiance * partOfBeam(light, w) : light.radiance;
}

// The same at a point of it, where it may have a texture.
vec3 emittedRadianceAt(DeviceScene scene, Light light, LightPoint point, vec3 w) {
    if (!hasEmissionTextures || light.texture == 0u) return emittedRadiance(light, point.normal, w);
    return isTwoSided(light) || dot(point.normal, w) > 0.0 ? texturedRadiance(scene, light, point.position) : vec3(0.0);
}

#endif
