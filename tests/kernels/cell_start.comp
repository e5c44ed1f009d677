// Where keys start among the photons of a map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"

MAP(uint, uint, uintPtr(args.photons.cells).at[x])
