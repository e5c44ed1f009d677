// Which lobes a scene has.
#ifndef LOBES_GLSL
#define LOBES_GLSL
#include "common.glsl"
#include "shared_kinds.h"

// Which lobes the materials of a scene have; layered ones have a diffuse lobe and another.
const bool hasDiffuse = (materialKinds & DIFFUSE_KINDS) != 0u;
const bool hasSpecular = (materialKinds & SPECULAR_KINDS) != 0u;
const bool hasGlossy = (materialKinds & GLOSSY_KINDS) != 0u;
const bool hasLayered = (materialKinds & LAYERED_KINDS) != 0u;

#endif
