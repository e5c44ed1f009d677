// Rays against a scene: (origin, direction).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "shared_paths.h"
#include "traverse.glsl"

MAP(VectorPair, Hit, closest(args.scene.at[0], x.a, x.b, NONE))
