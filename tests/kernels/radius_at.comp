// First gather radii at points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "radius_field.glsl"

MAP(vec3, float, radiusAt(args.photons, x))
