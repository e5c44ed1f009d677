// What light samples at a place choose by, as the pilot learned it: a tree cuts space into regions (in the manner of
// Mueller, Gross & Novak 2017); each has its own distribution over lights, and a tree over the two numbers that choose
// a direction of the sky, of the kind that guides photons have (guide.glsl).
#ifndef LIGHT_GUIDE_GLSL
#define LIGHT_GUIDE_GLSL
#include "common.glsl"
#include "light_kinds.glsl"
#include "light_view.glsl"
#include "shared_photons.h"
#include "shared_scene.h"

struct LightGuide {
    uint lights; // index into DeviceScene.directCdf
    uint sky;    // root of the region's tree, or NONE
};

const LightGuide UNGUIDED = LightGuide(0u, NONE);

// That of the region that holds a place.
LightGuide lightGuideAt(DeviceScene scene, vec3 place) {
    if (!hasSky || !hasLightGuide || scene.lightGuide == uvec2(0u)) return UNGUIDED;
    GuideNodePtr nodes = GuideNodePtr(scene.lightGuide);
    GuideNode node = nodes.at[0];
    while (node.axis < LIGHT_GUIDE_REGION) node = nodes.at[node.child + uint(place[node.axis] >= node.lower)];
    return LightGuide(uint(node.lower), node.child);
}

bool guidesLight(LightGuide guide, Light light) {
    return hasSky && hasLightGuide && guide.sky != NONE && light.kind == LIGHT_SKY;
}

// Warps uniform numbers to those of the region's density; returns the uniform density over that.
float guideSky(DeviceScene scene, LightGuide guide, inout vec2 u) {
    GuideNodePtr nodes = GuideNodePtr(scene.lightGuide);
    vec2 low = vec2(0.0), width = vec2(1.0);
    float inverseDensity = 1.0;
    GuideNode node = nodes.at[guide.sky];
    while (node.axis != NONE) {
        uint axis = node.axis;
        bool upper = u[axis] >= node.lower;
        float part = upper ? 1.0 - node.lower : node.lower;
        u[axis] = min((upper ? u[axis] - node.lower : u[axis]) / part, BELOW_ONE);
        width[axis] *= 0.5;
        if (upper) low[axis] += width[axis];
        inverseDensity *= 0.5 / part;
        node = nodes.at[node.child + uint(upper)];
    }
    u = min(low + width * u, BELOW_ONE);
    return inverseDensity;
}

// The same at numbers that are known.
float inverseDensityOfGuide(DeviceScene scene, LightGuide guide, vec2 u) {
    GuideNodePtr nodes = GuideNodePtr(scene.lightGuide);
    float inverseDensity = 1.0;
    GuideNode node = nodes.at[guide.sky];
    while (node.axis != NONE) {
        uint axis = node.axis;
        u[axis] *= 2.0;
        bool upper = u[axis] >= 1.0;
        if (upper) u[axis] -= 1.0;
        inverseDensity *= 0.5 / (upper ? 1.0 - node.lower : node.lower);
        node = nodes.at[node.child + uint(upper)];
    }
    return inverseDensity;
}

// A sample of a light as a place sees it, by the region's guide.
LightView viewGuided(DeviceScene scene, Light light, LightGuide guide, vec3 origin, vec2 u) {
    float inverseDensity = 1.0;
    if (guidesLight(guide, light)) inverseDensity = guideSky(scene, guide, u);
    LightView seen = viewLight(scene, light, origin, u);
    seen.inversePdf *= inverseDensity;
    return seen;
}

#endif
