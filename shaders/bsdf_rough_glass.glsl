// A rough interface of dielectrics (Walter et al. 2007): reflection and refraction at facets of GGX. Light that facets
// scatter more than once is lost.
#ifndef BSDF_ROUGH_GLASS_GLSL
#define BSDF_ROUGH_GLASS_GLSL
#include "fresnel.glsl"
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

float roughFresnel(Material m, bool leaving, float cosine) {
    return fresnelOf(m, ratioBeyond(m, leaving), min(1.0, cosine));
}

// Density of reflections alone; that of refractions is left out, as no light sample goes beyond the interface.
float pdfRoughGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float z = dot(wo, n);
    return roughFresnel(m, leaving, dot(wo, h)) * ggxDensity(m.alpha, n, h) / (2.0 * (z + stretched(m.alpha, z)));
}

// Of reflections.
vec3 evaluateRoughGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return vec3(roughFresnel(m, leaving, dot(wo, h)) * ggxDensity(m.alpha, n, h) *
                ggxVisibility(m.alpha, dot(wo, n), dot(wi, n)));
}

// Reflection with the probability of Fresnel's reflectance at the facet, else refraction.
Scattering sampleRoughGlass(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    vec3 h = sampleFacet(m.alpha, n, -d, 1.0, u.yz);
    float eta = ratioBeyond(m, leaving), cosine = min(1.0, -dot(d, h));
    bool reflects = u.x < roughFresnel(m, leaving, cosine);
    float cosT = sqrt(max(0.0, refractedCosine2(eta, cosine)));
    vec3 wi = reflects ? reflect(d, h) : normalize((d + cosine * h) / eta - cosT * h);
    float zi = reflects ? dot(wi, n) : -dot(wi, n);
    float weight = zi > 0.0 ? maskingOfOther(m.alpha, -dot(d, n), zi) : 0.0;
    if (reflects) return Scattering(wi, vec3(weight), n, 1.0, pdfRoughGlass(m, leaving, n, -d, wi));
    return Scattering(wi, weight * (hasTint ? m.color : vec3(1.0)), n, 1.0 / (eta * eta), 0.0);
}

// It has no diffuse lobe.
vec3 albedoRoughGlass(Material m, float cosine, float rest) { return vec3(1.0); }

vec3 baseRoughGlass(Material m, float rest) { return vec3(0.0); }

#endif
