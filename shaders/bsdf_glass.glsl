// A smooth interface of dielectrics.
#ifndef BSDF_GLASS_GLSL
#define BSDF_GLASS_GLSL
#include "fresnel.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

// At a facet h of a surface whose indices differ by channel: reflection of all channels, with the probability of their
// mean reflectance, or refraction of one of them, with a weight of about three.
Scattering sampleDispersive(Material m, vec3 d, vec3 h, vec3 n, bool leaving, float u) {
    float cosI = min(1.0, -dot(d, h));
    vec3 reflectances = fresnelByChannel(m, leaving, cosI);
    float mean = meanReflectance(reflectances);
    if (u < mean) return Scattering(reflect(d, h), reflectances / mean, n, 1.0, 0.0);
    uint channel = min(uint(3.0 * (u - mean) / (1.0 - mean)), 2u);
    float eta = ratiosBeyond(m, leaving)[channel];
    vec3 weight = hasTint ? m.color : vec3(1.0);
    for (uint i = 0u; i < 3u; i++) weight[i] *= i == channel ? 3.0 * (1.0 - reflectances[i]) / (1.0 - mean) : 0.0;
    return Scattering(refractAbout(d, h, eta, cosI), weight, n, 1.0 / (eta * eta), 0.0);
}

// Reflection with the probability `fresnel`, else refraction.
Scattering sampleGlass(Material m, vec3 d, vec3 n, bool leaving, float u) {
    if (hasDispersion && isDispersive(m)) return sampleDispersive(m, d, n, n, leaving, u);
    float eta = ratioBeyond(m, leaving);
    float cosI = min(1.0, -dot(d, n));
    if (u < fresnelOf(m, eta, cosI)) return reflectAbout(d, n, vec3(1.0));
    return Scattering(refractAbout(d, n, eta, cosI), hasTint ? m.color : vec3(1.0), n, 1.0 / (eta * eta), 0.0);
}

#endif
