// Rays that leave a primitive, against the scene.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "shared_paths.h"
#include "traverse.glsl"

MAP(StartCase, Hit, closest(args.scene.at[0], x.origin, x.direction, x.from))
