// Area lights: which one, where on it, how much it sends.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
#include "common.glsl"
#include "sampling.glsl"
#include "shared_scene.h"

struct LightPoint {
    vec3 position;
    vec3 magnitude; // as in Surface
    vec3 normal;
};

// The light whose part of the unit interval holds u.
uint chooseLight(DeviceScene scene, uvec2 cdf, float u) {
    if (!hasManyLights) return 0u;
    uint low = 0u;
    uint high = scene.lightCount - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (u < floatPtr(cdf).at[middle]) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// The probability of being chosen.
float lightProbability(uvec2 cdf, uint light) {
    if (!hasManyLights) return 1.0;
    return floatPtr(cdf).at[light] - (light > 0u ? floatPtr(cdf).at[light - 1u] : 0.0);
}

bool isSphere(Light light) {
    return hasSphereLights && ((!hasRectangleLights && !hasTriangleLights) || light.kind == LIGHT_SPHERE);
}

bool isTriangle(Light light) {
    return hasTriangleLights && ((!hasRectangleLights && !hasSphereLights) || light.kind == LIGHT_TRIANGLE);
}

bool isTwoSided(Light light) { return hasTwoSidedLights && light.twoSided != 0u; }

// The point a + place.x u + place.y v of a rectangle or triangle.
LightPoint flatLightAt(Light light, vec2 place) {
    // A shadow ray may hit a triangle of the light anywhere along it, so all components of its place count.
    vec3 magnitude = vec3(maxComponent(abs(light.a) + abs(light.a + light.u) + abs(light.a + light.v)));
    return LightPoint(light.a + place.x * light.u + place.y * light.v, magnitude, directionOfCross(light.u, light.v));
}

// A point of a light, uniform over area.
LightPoint sampleEmissionPoint(Light light, vec2 u) {
    if (isSphere(light)) {
        vec3 n = uniformSphere(u);
        return LightPoint(light.a + light.u.x * n, abs(light.a) + light.u.x, n);
    }
    return flatLightAt(light, isTriangle(light) ? uniformTriangle(u) : u);
}

// Radiance that a light sends in direction w from where its normal is n.
vec3 emittedRadiance(Light light, vec3 n, vec3 w) {
    return isTwoSided(light) || dot(n, w) > 0.0 ? light.radiance : vec3(0.0);
}

#endif
