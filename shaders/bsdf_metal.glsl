// Rough metal: GGX with Schlick's reflectance, and a diffuse lobe of what facets reflect more than once.
#ifndef BSDF_METAL_GLSL
#define BSDF_METAL_GLSL
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

Scattering sampleMetal(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    return sampleGgx(m.alpha, m.color, d, n, u.yz);
}

vec3 evaluateMetal(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    return evaluateGgx(m.alpha, m.color, n, wo, wi);
}

float pdfMetal(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) { return ggxPdf(m.alpha, n, wo, wi); }

// Of all light from a direction, what the facets reflect at once; `rest` is the part that is not, were they perfect.
vec3 albedoMetal(Material m, float cosine, float rest) { return (1.0 - rest) * schlick(m.color, cosine); }

// The diffuse lobe's colour: of what facets reflect twice and more often (Kulla & Conty 2017), the mean reflectance at
// each but the first; `rest` is the mean over all directions.
vec3 baseMetal(Material m, float rest) {
    vec3 mean = (20.0 * m.color + 1.0) / 21.0; // of Schlick's reflectance, by the cosine law
    return mean * mean * (1.0 - rest) / (1.0 - mean * rest);
}

#endif
