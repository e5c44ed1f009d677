// Plastic: a rough coat of a dielectric, GGX with Schlick's reflectance, over a diffuse base, which gets what the coat
// leaves (the separable form of Kelemen & Szirmay-Kalos 2001).
#ifndef BSDF_PLASTIC_GLSL
#define BSDF_PLASTIC_GLSL
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

// Reflectance at normal incidence of the coat.
vec3 coat(Material m) {
    float r = (m.ior - 1.0) / (m.ior + 1.0);
    return vec3(r * r);
}

Scattering samplePlastic(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    return sampleGgx(m.alpha, coat(m), d, n, u.yz);
}

vec3 evaluatePlastic(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    return evaluateGgx(m.alpha, coat(m), n, wo, wi);
}

float pdfPlastic(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) { return ggxPdf(m.alpha, n, wo, wi); }

// What the coat reflects; `rest` is what it leaves.
vec3 albedoPlastic(Material m, float cosine, float rest) { return vec3(1.0 - rest); }

vec3 basePlastic(Material m, float rest) { return m.color; }

#endif
