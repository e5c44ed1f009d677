// Mirrors and glass: Fresnel reflectance, and the one direction in which light goes on.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
#include "common.glsl"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"

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

// Where light goes on at a specular surface.
struct Scattering {
    vec3 direction;
    vec3 weight;         // reflectance or tint; the choice by Fresnel is in the probability
    vec3 normal;         // that it turned about, on the side of incidence
    float radianceScale; // (index of the side of incidence / index of the side beyond)^2, for radiance alone
};

Scattering reflectAbout(vec3 d, vec3 n, vec3 weight) { return Scattering(reflect(d, n), weight, n, 1.0); }

// Reflection with the probability `fresnel`, else refraction.
Scattering scatterGlass(Material m, vec3 d, vec3 n, bool leaving, float u) {
    float eta = leaving ? 1.0 / m.ior : m.ior;
    float cosI = min(1.0, -dot(d, n));
    bool schlick = hasSchlickFresnel && (!hasExactFresnel || m.schlick != 0u);
    if (u < fresnel(schlick, eta, cosI)) return reflectAbout(d, n, vec3(1.0));
    float cosT = sqrt(max(0.0, refractedCosine2(eta, cosI)));
    vec3 direction = normalize((d + cosI * n) / eta - cosT * n);
    return Scattering(direction, hasTint ? m.color : vec3(1.0), n, 1.0 / (eta * eta));
}

Scattering scatterAbout(Material m, vec3 d, vec3 n, bool leaving, float u) {
    if (hasGlass && (!hasMirror || m.kind == MATERIAL_GLASS)) return scatterGlass(m, d, n, leaving, u);
    return reflectAbout(d, n, m.color);
}

// Specular scattering of a ray of direction d. About the shading normal, unless that would put the ray on the
// side of the geometric normal where the other kind of event belongs; then about the geometric one.
Scattering scatterSpecular(Material m, Surface s, vec3 d, float u) {
    bool leaving = dot(d, s.normal) > 0.0;
    vec3 geometric = leaving ? -s.normal : s.normal;
    if (!hasSmoothNormals) return scatterAbout(m, d, geometric, leaving, u);
    vec3 shading = leaving ? -s.shading : s.shading;
    if (dot(d, shading) < 0.0) {
        Scattering result = scatterAbout(m, d, shading, leaving, u);
        bool reflected = dot(result.direction, shading) > 0.0;
        if (reflected == (dot(result.direction, geometric) > 0.0)) return result;
    }
    return scatterAbout(m, d, geometric, leaving, u);
}

// What a photon's flux is multiplied by since shading normals are not the geometric ones (Veach 1997, eq. 5.19);
// wi against its direction of arrival, wo along that of departure, for a specular event about n.
float specularCorrection(vec3 wi, vec3 wo, vec3 n, vec3 geometric) {
    if (!hasSmoothNormals || n == geometric || n == -geometric) return 1.0;
    return abs(dot(wi, n) * dot(wo, geometric)) / max(abs(dot(wi, geometric) * dot(wo, n)), 1e-6);
}

// Specular vertices of a path since its last diffuse one, up to 63, and its flags after one more.
uint specularRun(uint flags) { return (flags & PATH_SPECULARS) / PATH_SPECULAR; }

uint afterSpecular(uint flags) { return (flags & PATH_SPECULARS) == PATH_SPECULARS ? flags : flags + PATH_SPECULAR; }

// Probability with which a path goes on at a specular surface after a run of others. Light within glass near the
// critical angle may be reflected for ever without loss: from the 32nd on a tenth ends at each. Only a run counts: in a
// bright room, where paths have hundreds of vertices, the weights that make up for such ends would grow without bound.
float specularSurvival(vec3 weight, uint run) { return min(maxComponent(weight), run < 32u ? 1.0 : 0.9); }

bool isDiffuse(Material m) { return hasDiffuse && ((!hasMirror && !hasGlass) || m.kind == MATERIAL_DIFFUSE); }

#endif
