// glTF's metallic-roughness: a rough coat over a diffuse base where it is a dielectric, and rough metal, mixed. Both
// share one lobe of GGX, with Schlick's reflectance; the diffuse lobe is that of plastic and of metal, mixed likewise.
#ifndef BSDF_STANDARD_GLSL
#define BSDF_STANDARD_GLSL
#include "bsdf_metal.glsl"
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

vec3 reflectanceStandard(Material m, float cosine) {
    return schlick(mix(m.normalIncidence, m.color, m.metallic), mix(m.grazing, 1.0, m.metallic), cosine);
}

// The cosine of two directions with the one half-way between them.
float halfwayCosine(vec3 wo, vec3 wi) { return sqrt(max(0.0, 0.5 + 0.5 * dot(wo, wi))); }

Scattering sampleStandard(Material m, vec3 d, vec3 n, bool leaving, vec3 u) {
    Scattering event = sampleGgx(m.alpha, vec3(1.0), d, n, u.yz);
    event.weight *= reflectanceStandard(m, halfwayCosine(-d, event.direction));
    return event;
}

vec3 evaluateStandard(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) {
    return evaluateGgx(m.alpha, vec3(1.0), n, wo, wi) * reflectanceStandard(m, halfwayCosine(wo, wi));
}

float pdfStandard(Material m, bool leaving, vec3 n, vec3 wo, vec3 wi) { return ggxPdf(m.alpha, n, wo, wi); }

// `rest` is what would be left if the metal were perfect.
vec3 albedoStandard(Material m, float cosine, float rest) {
    Material perfect = m;
    perfect.color = vec3(1.0);
    return (1.0 - rest) * reflectanceStandard(m, cosine) / maxComponent(reflectanceStandard(perfect, cosine) + 1e-30);
}

// `rest` is the mean of what perfect metal leaves.
vec3 baseStandard(Material m, float rest) { return mix(m.color, baseMetal(m, rest), m.metallic); }

// What is left, by what it would be for reflectances of 0 and of 1 at normal incidence: between them it is linear.
float restStandard(Material m, float none, float all) {
    float coat =
        1.0 - m.grazing + (m.grazing - maxComponent(m.normalIncidence)) * none + maxComponent(m.normalIncidence) * all;
    return mix(coat, all, m.metallic);
}

#endif
