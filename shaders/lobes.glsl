// Which lobes a scene has.
#ifndef LOBES_GLSL
#define LOBES_GLSL
#include "common.glsl"
#include "shared_kinds.h"
#include "shared_scene.h"

// Which lobes the materials of a scene have; layered ones have a diffuse lobe and another.
const bool hasDiffuse = (materialKinds & DIFFUSE_KINDS) != 0u;
const bool hasSpecular = (materialKinds & SPECULAR_KINDS) != 0u;
#ifdef PLAIN
const bool hasGlossy = false;
const bool hasLayered = false;
#else
const bool hasGlossy = (materialKinds & GLOSSY_KINDS) != 0u;
const bool hasLayered = (materialKinds & LAYERED_KINDS) != 0u;
#endif

// Rough glass in which photons may lie.
const bool hasRoughGlass = (materialKinds & 1u << MATERIAL_ROUGH_GLASS) != 0u;
const bool hasWideGlass = hasWide && hasRoughGlass;

bool isStandard(Material m) { return (materialKinds & 1u << MATERIAL_STANDARD) != 0u && m.kind == MATERIAL_STANDARD; }

// Rows of DeviceScene.rests for each roughness.
uint restRows(Material m) { return isStandard(m) ? 2u : 1u; }

#endif
