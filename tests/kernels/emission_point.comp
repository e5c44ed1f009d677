// Points of the first light of a scene where photons start.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light_sampling.glsl"
#include "shared_scene.h"

LightValues values(LightPoint p) { return LightValues(p.position, p.magnitude, p.normal); }

MAP(vec2, LightValues, values(sampleEmissionPoint(LightPtr(args.scene.at[0].lights).at[0], x)))
