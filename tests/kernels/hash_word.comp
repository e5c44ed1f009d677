// The hash of a word.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "hash.h"
#include "random.glsl"

MAP(uint, uint, hash(x))
