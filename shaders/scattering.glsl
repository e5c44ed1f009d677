// Where light goes on after an event that is not diffuse.
#ifndef SCATTERING_GLSL
#define SCATTERING_GLSL
#include "common.glsl"

struct Scattering {
    vec3 direction;
    vec3 weight;         // reflectance or tint; the choice by Fresnel is in the probability
    vec3 normal;         // that it turned about, on the side of incidence
    float radianceScale; // (index of the side of incidence / index of the side beyond)^2, for radiance alone
    float pdf;           // over solid angle, given the lobe; 0: there is one direction alone
};

Scattering reflectAbout(vec3 d, vec3 n, vec3 weight) { return Scattering(reflect(d, n), weight, n, 1.0, 0.0); }

#endif
