// The hash of a pair of words.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "hash.h"
#include "random.glsl"

MAP(uvec2, uint, hash(x.x, x.y))
