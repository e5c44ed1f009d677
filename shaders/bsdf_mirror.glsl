// A perfect mirror, on both sides.
#ifndef BSDF_MIRROR_GLSL
#define BSDF_MIRROR_GLSL
#include "scattering.glsl"
#include "shared_scene.h"

Scattering sampleMirror(Material m, vec3 d, vec3 n, bool leaving, float u) { return reflectAbout(d, n, m.color); }

#endif
