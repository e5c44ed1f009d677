// Lights that glass reflects. Few paths are reflected there, and where these meet a light, a few bright ones among many
// dim ones are specks. So where the reflected ray is aimed at a light, half of the paths take it.
#ifndef GLINT_GLSL
#define GLINT_GLSL
#include "bsdf_glass.glsl"
#include "light_sun.glsl"
#include "material.glsl"
#include "shared_scene.h"
#include "surface.glsl"

const uint MAX_GLINTS = 8u; // the first lights, which are looked at

// Whether a ray would run into a light if nothing were in its way.
bool isAimedAt(Light light, vec3 origin, vec3 d) {
    const uint has = lightKinds;
    if (hasSun && light.kind == LIGHT_SUN) return isInSun(light, d);
    if ((has & 1u << LIGHT_SPHERE) != 0u && light.kind == LIGHT_SPHERE) {
        vec3 toCenter = light.a - origin;
        float along = dot(toCenter, d);
        vec3 across = toCenter - along * d;
        return along > 0.0 && dot(across, across) <= light.u.x * light.u.x;
    }
    if (light.kind != LIGHT_RECTANGLE && light.kind != LIGHT_TRIANGLE) return false;
    vec3 n = cross(light.u, light.v);
    float towards = dot(d, n);
    if (towards == 0.0 || (towards > 0.0 && !isTwoSided(light))) return false;
    float t = dot(light.a - origin, n) / towards;
    vec3 q = origin + t * d - light.a;
    float x = dot(cross(q, light.v), n), y = dot(cross(light.u, q), n), whole = dot(n, n);
    return t > 0.0 && min(x, y) >= 0.0 && (light.kind == LIGHT_TRIANGLE ? x + y : max(x, y)) <= whole;
}

// Changes the number u by which smooth glass chooses between reflection and refraction so that half of the paths are
// reflected where a light may be seen that way, and returns the weight that makes up for it.
float chooseGlint(DeviceScene scene, Material m, Surface s, vec3 d, inout float u) {
    if ((materialKinds & 1u << MATERIAL_GLASS) == 0u || m.kind != MATERIAL_GLASS || isPassage(m)) return 1.0;
    vec3 n = scatteringNormal(s, d);
    float reflectance = meanReflectance(fresnelByChannel(m, dot(d, s.normal) > 0.0, min(1.0, -dot(d, n))));
    if (!(reflectance > 0.0 && reflectance < 0.5)) return 1.0;
    bool aimed = false;
    for (uint i = 0u; i < min(scene.lightCount, MAX_GLINTS) && !aimed; i++)
        aimed = isAimedAt(LightPtr(scene.lights).at[i], s.position, reflect(d, n));
    if (!aimed) return 1.0;
    bool reflected = u < 0.5;
    u = reflected ? 2.0 * u * reflectance : reflectance + (2.0 * u - 1.0) * (1.0 - reflectance);
    return 2.0 * (reflected ? reflectance : 1.0 - reflectance);
}

#endif
