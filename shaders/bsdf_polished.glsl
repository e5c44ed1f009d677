// Polished metal: a mirror with Schlick's reflectance.
#ifndef BSDF_POLISHED_GLSL
#define BSDF_POLISHED_GLSL
#include "ggx.glsl"
#include "scattering.glsl"
#include "shared_scene.h"

Scattering samplePolished(Material m, vec3 d, vec3 n, bool leaving, float u) {
    return reflectAbout(d, n, schlick(m.color, -dot(d, n)));
}

#endif
