// Lights that are endlessly far: suns and the sky, by direction alone.
#ifndef LIGHT_ENDLESS_GLSL
#define LIGHT_ENDLESS_GLSL
#include "light.glsl"
#include "light_kinds.glsl"
#include "light_sky.glsl"
#include "light_sun.glsl"

bool isEndless(Light light) { return hasEndless && (ENDLESS_KINDS >> light.kind & 1u) != 0u; }

// A direction in which one is seen.
SkyPoint sampleEndless(DeviceScene scene, Light light, vec2 u) {
    if (hasSky && (!hasSun || light.kind == LIGHT_SKY)) return sampleSky(scene, u);
    return SkyPoint(sampleSun(light, u), light.radiance, solidAngleOfSun(light));
}

// What one sends from a direction, and the solid angle that it stands for among samples.
SkyPoint endlessAt(DeviceScene scene, Light light, vec3 w) {
    if (hasSky && (!hasSun || light.kind == LIGHT_SKY)) return skyAt(scene, w);
    return SkyPoint(w, isInSun(light, w) ? light.radiance : vec3(0.0), solidAngleOfSun(light));
}

#endif
