// Density estimates with the radius of the map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "density.glsl"
#include "shared_camera.h"

MAP(Query, vec3, estimateWithin(args.photons, x, args.photons.radius))
