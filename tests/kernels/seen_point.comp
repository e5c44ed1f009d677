// Points of the first light of a scene as seen from x.a, by the numbers in x.b.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light_sampling.glsl"
#include "shared_scene.h"

SeenValues values(LightSample p) {
    return SeenValues(p.point.position, p.point.magnitude, p.point.normal, p.inversePdf);
}

MAP(VectorPair, SeenValues, values(sampleLight(LightPtr(args.scene.at[0].lights).at[0], x.a, x.b.xy)))
