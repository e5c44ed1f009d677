// A rough interface of dielectrics (Walter et al. 2007): reflection and refraction at facets of GGX. Light that facets
// scatter more than once is lost.
#ifndef BSDF_ROUGH_GLASS_GLSL
#define BSDF_ROUGH_GLASS_GLSL
#include "bsdf_glass.glsl"
#include "fresnel.glsl"
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

vec3 roughFresnel(Material m, bool leaving, float cosine) { return fresnelByChannel(m, leaving, min(1.0, cosine)); }

float reflectionProbability(Material m, bool leaving, float cosine) {
    vec3 reflectances = roughFresnel(m, leaving, cosine);
    return isDispersive(m) ? meanReflectance(reflectances) : reflectances.x;
}

// Density of reflections.
float pdfRoughGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return reflectionProbability(m, leaving, dot(wo, h)) * visibleFacetPdf(m.alpha, n, h, wo);
}

// Of reflections.
vec3 evaluateRoughGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    return roughFresnel(m, leaving, dot(wo, h)) * ggxValue(m.alpha, n, h, wo, wi);
}

// Refractions (Walter et al. 2007, eqs. 16, 17 and 21): what light that arrives from wi, beyond the interface, brings
// as radiance towards wo, times the cosine of wi, and the density with which wo is refracted to wi. Where indices
// differ by channel, each has another facet; then the density is left at 0.
vec3 refractRoughGlass(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi, out float pdf) {
    float zo = dot(wo, n), zi = -dot(wi, n);
    vec3 value = vec3(0.0);
    pdf = 0.0;
    if (!(zo > 0.0 && zi > 0.0)) return value;
    bool apart = isDispersive(m);
    for (uint i = 0u; i < (apart ? 3u : 1u); i++) {
        float eta = apart ? ratiosBeyond(m, leaving)[i] : ratioBeyond(m, leaving);
        vec3 h = normalize(wo + eta * wi);
        if (dot(h, n) < 0.0) h = -h;
        float o = dot(wo, h), beyond = -dot(wi, h);
        if (!(o > 0.0 && beyond > 0.0)) continue;
        float root = o - eta * beyond;
        float density = (1.0 - roughFresnel(m, leaving, o)[i]) * visibleFacetPdf(m.alpha, n, h, wo) * 4.0 * o * eta *
                        eta * beyond / (root * root);
        float result = density * maskingOfOther(m.alpha, zo, zi) / (eta * eta);
        if (apart) value[i] = result;
        else value = vec3(result);
        pdf = apart ? 0.0 : density;
    }
    return hasTint ? value * m.color : value;
}

// Reflection with the probability of Fresnel's reflectance at the facet, else refraction.
Scattering sampleRoughGlass(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    vec3 h = sampleFacet(m.alpha, n, -d, 1.0, u.yz);
    float eta = ratioBeyond(m, leaving), cosine = min(1.0, -dot(d, h));
    bool reflects = u.x < reflectionProbability(m, leaving, cosine);
    Scattering event;
    if (isDispersive(m)) event = sampleDispersive(m, d, h, n, leaving, u.x);
    else if (reflects) event = reflectAbout(d, h, vec3(1.0));
    else event = Scattering(refractAbout(d, h, eta, cosine), hasTint ? m.color : vec3(1.0), n, 1.0 / (eta * eta), 0.0);
    event.normal = n;
    float zi = reflects ? dot(event.direction, n) : -dot(event.direction, n);
    event.weight *= zi > 0.0 ? maskingOfOther(m.alpha, -dot(d, n), zi) : 0.0;
    if (reflects) event.pdf = pdfRoughGlass(m, leaving, n, -d, event.direction);
    else refractRoughGlass(m, leaving, n, -d, event.direction, event.pdf);
    return event;
}

// It has no diffuse lobe.
vec3 albedoRoughGlass(Material m, float cosine, float rest) { return vec3(1.0); }

vec3 baseRoughGlass(Material m, float rest) { return vec3(0.0); }

#endif
