// Samples of the first light of a scene from x.a, by the numbers in x.b.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light_sampling.glsl"
#include "shared_scene.h"

LightSampleValues values(LightSample p) {
    return LightSampleValues(p.point.position, p.point.magnitude, p.point.normal, p.inversePdf);
}

MAP(VectorPair, LightSampleValues, values(sampleLight(LightPtr(args.scene.at[0].lights).at[0], x.a, x.b.xy)))
