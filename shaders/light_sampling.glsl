// Points of area lights, whatever their kind: where photons start, and as seen from a place.
#ifndef LIGHT_SAMPLING_GLSL
#define LIGHT_SAMPLING_GLSL
#include "light.glsl"
#include "light_rectangle.glsl"
#include "light_sphere.glsl"
#include "light_triangle.glsl"
#include "shared_kinds.h"

// Whether a light is of a kind, asked in the order of the list: the last one that a scene has needs no look.
bool isNextKind(Light light, uint kind) {
    const uint kinds = lightKinds & AREA_KINDS;
    return (kinds & 1u << kind) != 0u && (kinds >> kind == 1u || light.kind == kind);
}

// A point of a light, uniform over area.
#define X(id, NAME, name, words)                                                                                       \
    if (isNextKind(light, id)) return emit##name(light, u);
LightPoint sampleEmissionPoint(Light light, vec2 u) {
    AREA_LIGHTS(X)
    return LightPoint(light.a, abs(light.a), light.u);
}
#undef X

// A point of a light as it is seen from `origin`.
#define X(id, NAME, name, words)                                                                                       \
    if (isNextKind(light, id)) return sample##name(light, origin, u);
LightSample sampleLight(Light light, vec3 origin, vec2 u) {
    AREA_LIGHTS(X)
    return LightSample(LightPoint(light.a, abs(light.a), light.u), 0.0);
}
#undef X

// The solid angle that a point of a light stands for among those that sampleLight chooses.
#define X(id, NAME, name, words)                                                                                       \
    if (isNextKind(light, id)) return inversePdf##name(light, origin, point);
float inversePdfOfLight(Light light, vec3 origin, LightPoint point) {
    AREA_LIGHTS(X)
    return 0.0;
}
#undef X

#endif
