// Fresnel reflectance and refraction of smooth dielectrics.
#ifndef FRESNEL_GLSL
#define FRESNEL_GLSL
#include "common.glsl"
#include "shared_scene.h"

// Unpolarised Fresnel reflectance of a smooth dielectric; eta = index beyond / index on the side of incidence,
// cosines with the normal on both sides (Born & Wolf 1999, sec. 1.5.2). Where the indices hardly differ, the
// differences of cosines in the amplitudes would cancel: by Snell's law they are eta^2 - 1 over the sums.
float fresnelExact(float eta, float cosI, float cosT) {
    float e2 = eta * eta;
    float difference = (eta - 1.0) * (eta + 1.0);
    float sumS = cosI + eta * cosT;
    float sumP = eta * cosI + cosT;
    bool near = abs(difference) < 0.25;
    float s = near ? difference / sumS : cosI - eta * cosT;
    float p = near ? difference * ((e2 + 1.0) * cosI * cosI - 1.0) / (e2 * sumP) : eta * cosI - cosT;
    return min(1.0, 0.5 * (s * s / (sumS * sumS) + p * p / (sumP * sumP)));
}

// Schlick's approximation (1994, eq. 15), with the cosine on the side of the lower index.
float fresnelSchlick(float eta, float cosI, float cosT) {
    float r = (1.0 - eta) / (1.0 + eta);
    float x = 1.0 - (eta > 1.0 ? cosI : cosT);
    return mix(r * r, 1.0, x * x * x * x * x);
}

// Squared cosine of the refracted direction (Snell); not above 0: total reflection.
float refractedCosine2(float eta, float cosI) { return ((eta - 1.0) * (eta + 1.0) + cosI * cosI) / (eta * eta); }

// Fraction of light that a dielectric reflects.
float fresnel(bool schlick, float eta, float cosI) {
    float cos2 = refractedCosine2(eta, cosI);
    if (cos2 <= 0.0) return 1.0;
    float cosT = sqrt(cos2);
    return schlick ? fresnelSchlick(eta, cosI, cosT) : fresnelExact(eta, cosI, cosT);
}

// Index beyond over index on the side of incidence.
float ratioBeyond(Material m, bool leaving) { return leaving ? 1.0 / m.ior : m.ior; }

float fresnelOf(Material m, float eta, float cosI) {
    return fresnel(hasSchlickFresnel && (!hasExactFresnel || m.schlick != 0u), eta, cosI);
}

// A unit direction d after refraction at a facet h on its side.
vec3 refractAbout(vec3 d, vec3 h, float eta, float cosI) {
    float cosT = sqrt(max(0.0, refractedCosine2(eta, cosI)));
    return normalize((d + cosI * h) / eta - cosT * h);
}

// ---- Dispersion: three channels, of which refraction takes one --------------------------------------

bool isDispersive(Material m) { return hasDispersion && m.spread != vec2(0.0); }

// Ratios as ratioBeyond, for red, green and blue.
vec3 ratiosBeyond(Material m, bool leaving) {
    vec3 ratios = m.ior + vec3(m.spread.x, 0.0, m.spread.y);
    return leaving ? 1.0 / ratios : ratios;
}

vec3 fresnelByChannel(Material m, bool leaving, float cosI) {
    if (!isDispersive(m)) return vec3(fresnelOf(m, ratioBeyond(m, leaving), cosI));
    vec3 etas = ratiosBeyond(m, leaving);
    return vec3(fresnelOf(m, etas.x, cosI), fresnelOf(m, etas.y, cosI), fresnelOf(m, etas.z, cosI));
}

// The probability of reflection by these.
float meanReflectance(vec3 reflectances) { return (reflectances.x + reflectances.y + reflectances.z) / 3.0; }

#endif
