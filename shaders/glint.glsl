// Lights that glass reflects. Few paths are reflected there, and where these meet a light, a few bright ones among many
// dim ones are specks. So where the reflected ray is aimed at a light, half of the paths take it; within glass, where
// it comes out aimed at one.
#ifndef GLINT_GLSL
#define GLINT_GLSL
#include "bsdf_glass.glsl"
#include "fresnel.glsl"
#include "light_sun.glsl"
#include "material.glsl"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"
#include "traverse.glsl"

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

bool isAimedAtAny(DeviceScene scene, vec3 origin, vec3 d) {
    for (uint i = 0u; i < min(scene.lightCount, MAX_GLINTS); i++)
        if (isAimedAt(LightPtr(scene.lights).at[i], origin, d)) return true;
    return false;
}

// Whether a ray within glass comes out aimed at a light. A guess: it takes all glass to lie in air, knows one face, and
// looks at nothing in the light's way.
bool comesOutAimed(DeviceScene scene, Surface s, vec3 d) {
    Path path;
    path.origin = leave(s, d);
    path.direction = d;
    Hit hit = closest(scene, path.origin, d, s.primitive);
    if (hit.primitive == NONE) return isAimedAtAny(scene, path.origin, d);
    s = surfaceAt(scene, path, hit);
    if (s.light != NONE) return true;
    Material m = MaterialPtr(scene.materials).at[s.material];
    if (m.kind != MATERIAL_GLASS) return false;
    vec3 n = scatteringNormal(s, d);
    float eta = ratioBeyond(m, dot(d, s.normal) > 0.0), cosine = min(1.0, -dot(d, n));
    return refractedCosine2(eta, cosine) > 0.0 && isAimedAtAny(scene, s.position, refractAbout(d, n, eta, cosine));
}

// Changes the number u by which smooth glass chooses between reflection and refraction so that half of the paths are
// reflected where a light may be seen that way, and returns the weight that makes up for it: below 2.
float chooseGlint(DeviceScene scene, Material m, Surface s, vec3 d, inout float u) {
    if ((materialKinds & 1u << MATERIAL_GLASS) == 0u || m.kind != MATERIAL_GLASS || isPassage(m)) return 1.0;
    vec3 n = scatteringNormal(s, d), reflected = reflect(d, n);
    bool leaving = dot(d, s.normal) > 0.0;
    float reflectance = meanReflectance(fresnelByChannel(m, leaving, min(1.0, -dot(d, n))));
    if (!(reflectance > 0.0 && reflectance < 0.5)) return 1.0;
    if (!(leaving ? comesOutAimed(scene, s, reflected) : isAimedAtAny(scene, s.position, reflected))) return 1.0;
    bool reflects = u < 0.5;
    u = reflects ? 2.0 * u * reflectance : reflectance + (2.0 * u - 1.0) * (1.0 - reflectance);
    return 2.0 * (reflects ? reflectance : 1.0 - reflectance);
}

#endif
