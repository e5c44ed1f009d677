// Lights without a size: points and spots.
#ifndef LIGHT_DELTA_GLSL
#define LIGHT_DELTA_GLSL
#include "light.glsl"
#include "light_kinds.glsl"

bool isDelta(Light light) { return hasDeltaLights && (DELTA_LIGHT_KINDS >> light.kind & 1u) != 0u; }

#endif
