// Density estimates from the k nearest photons; k stands in place of the column.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "density.glsl"
#include "shared_camera.h"

MAP(Query, vec3, estimateWithin(args.photons, x, nearestRadius(args.photons, x, x.column)))
