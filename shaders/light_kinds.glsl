// Which kinds of lights a scene has.
#ifndef LIGHT_KINDS_GLSL
#define LIGHT_KINDS_GLSL
#include "common.glsl"
#include "shared_kinds.h"

#ifdef PLAIN
const bool hasDeltaLights = false, hasSpots = false, hasEndless = false, hasSun = false, hasSky = false;
#else
const bool hasDeltaLights = (lightKinds & DELTA_LIGHT_KINDS) != 0u;
const bool hasSpots = (lightKinds & 1u << LIGHT_SPOT) != 0u;
const bool hasEndless = (lightKinds & ENDLESS_KINDS) != 0u;
const bool hasSun = (lightKinds & 1u << LIGHT_SUN) != 0u;
const bool hasSky = (lightKinds & 1u << LIGHT_SKY) != 0u;
#endif

#endif
