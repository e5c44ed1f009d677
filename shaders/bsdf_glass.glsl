// A smooth interface of dielectrics.
#ifndef BSDF_GLASS_GLSL
#define BSDF_GLASS_GLSL
#include "fresnel.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

// Reflection with the probability `fresnel`, else refraction.
Scattering sampleGlass(Material m, vec3 d, vec3 n, bool leaving, float u) {
    float eta = ratioBeyond(m, leaving);
    float cosI = min(1.0, -dot(d, n));
    if (u < fresnelOf(m, eta, cosI)) return reflectAbout(d, n, vec3(1.0));
    float cosT = sqrt(max(0.0, refractedCosine2(eta, cosI)));
    vec3 direction = normalize((d + cosI * n) / eta - cosT * n);
    return Scattering(direction, hasTint ? m.color : vec3(1.0), n, 1.0 / (eta * eta), 0.0);
}

#endif
