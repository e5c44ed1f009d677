// Pairs of points with something between them: 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "traverse.glsl"

MAP(VectorPair, uint, uint(occluded(args.scene.at[0], x.a, x.b, NONE)))
