// Density estimates with the radius of the map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "random.glsl"
#include "frame.glsl"
#include "grid.glsl"
#include "density.glsl"

MAP(Query, vec3, estimateWithin(args.photons, x, args.photons.radius))
