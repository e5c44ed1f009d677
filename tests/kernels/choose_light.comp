// Lights chosen by numbers in [0, 1).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light.glsl"

MAP(float, uint, chooseLight(args.scene.at[0], args.scene.at[0].lightCdf, 0u, x))
