// One over the part of discs that surfaces cover, with the radius of the map: x of the disc, y of that of half the
// area.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "coverage.glsl"

MAP(Query, vec2, inverseCoverage(args.scene.at[0], x, args.photons.radius))
