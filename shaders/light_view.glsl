// Lights of all kinds as a place sees them, by samples.
#ifndef LIGHT_VIEW_GLSL
#define LIGHT_VIEW_GLSL
#include "light.glsl"
#include "light_delta.glsl"
#include "light_endless.glsl"
#include "light_sampling.glsl"
#include "offset.glsl"
#include "opacity.glsl"
#include "shared_camera.h"

// A sample of a light as a place sees it.
struct LightView {
    vec3 w; // towards it
    vec3 radiance;
    float inversePdf; // the solid angle that it stands for; of a light without a size, which has an intensity in place
                      // of a radiance, one over the distance squared
    vec3 target;      // of a shadow ray
    uint flags;       // SHADOW_ENDLESS: its target is a direction
    bool isFound;     // whether rays find the light, too
};

LightView viewLight(DeviceScene scene, Light light, vec3 origin, vec2 place) {
    if (hasEndless && isEndless(light)) {
        SkyPoint point = sampleEndless(scene, light, place);
        return LightView(point.w, point.radiance, point.inversePdf, point.w, SHADOW_ENDLESS, true);
    }
    if (hasDeltaLights && isDelta(light)) {
        vec3 toLight = light.a - origin;
        float distance2 = dot(toLight, toLight);
        vec3 w = toLight * inversesqrt(distance2);
        return LightView(w, light.radiance * partOfBeam(light, -w), 1.0 / distance2, light.a, 0u, false);
    }
    LightSample seen = sampleLight(light, origin, place);
    vec3 w = normalize(seen.point.position - origin);
    vec3 lightSide = dot(w, seen.point.normal) > 0.0 ? -seen.point.normal : seen.point.normal;
    vec3 radiance = emittedRadianceAt(scene, light, seen.point, -w);
    if (hasOpacity) radiance *= opacityOfLight(scene, light, seen.point.position);
    return LightView(w, radiance, seen.inversePdf, offsetPoint(seen.point.position, seen.point.magnitude, lightSide),
                     0u, true);
}

#endif
