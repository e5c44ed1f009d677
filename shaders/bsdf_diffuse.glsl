// Lambert's law, on both sides.
#ifndef BSDF_DIFFUSE_GLSL
#define BSDF_DIFFUSE_GLSL
#include "scattering.glsl"
#include "shared_scene.h"

// All of its light is in the lobe where photons are gathered.
Scattering sampleDiffuse(Material m, vec3 d, vec3 n, bool leaving, float u) {
    return Scattering(n, vec3(0.0), n, 1.0, 0.0);
}

#endif
