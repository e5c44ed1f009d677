// A sheet of glass, thin against what is around it: light is reflected to and fro between its sides, and what goes
// through keeps its direction. Smooth, or with facets of GGX that blur both alike.
#ifndef BSDF_THIN_GLASS_GLSL
#define BSDF_THIN_GLASS_GLSL
#include "fresnel.glsl"
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

// What both sides reflect together: r + (1 - r)^2 r (1 + r^2 + r^4 + ...).
float sheetReflectance(Material m, float cosine) {
    float r = fresnelOf(m, m.ior, min(1.0, cosine));
    return 2.0 * r / (1.0 + r);
}

Scattering sampleThinGlass(Material m, vec3 d, vec3 n, bool leaving, float u) {
    if (u < sheetReflectance(m, -dot(d, n))) return reflectAbout(d, n, vec3(1.0));
    return Scattering(d, hasTint ? m.color : vec3(1.0), n, 1.0, 0.0);
}

// Density of reflections alone, as that of rough glass.
float pdfRoughThinGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return sheetReflectance(m, dot(wo, h)) * visibleFacetPdf(m.alpha, n, h, wo);
}

vec3 evaluateRoughThinGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return vec3(sheetReflectance(m, dot(wo, h)) * ggxValue(m.alpha, n, h, wo, wi));
}

// What goes through is the reflection's mirror image.
Scattering sampleRoughThinGlass(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    vec3 h = sampleFacet(m.alpha, n, -d, 1.0, u.yz), wi = reflect(d, h);
    float z = dot(wi, n);
    vec3 weight = vec3(z > 0.0 ? maskingOfOther(m.alpha, -dot(d, n), z) : 0.0);
    if (u.x < sheetReflectance(m, -dot(d, h)))
        return Scattering(wi, weight, n, 1.0, pdfRoughThinGlass(m, leaving, n, -d, wi));
    return Scattering(wi - 2.0 * z * n, hasTint ? weight * m.color : weight, n, 1.0, 0.0);
}

// It has no diffuse lobe.
vec3 albedoRoughThinGlass(Material m, float cosine, float rest) { return vec3(1.0); }

vec3 baseRoughThinGlass(Material m, float rest) { return vec3(0.0); }

#endif
