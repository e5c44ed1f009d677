// Directions of the sky from the places x.a, by the numbers in x.b, guided: b is one, a the factor of the density as it
// was drawn and as it is found from the direction, and the index of the region's first light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light_guide.glsl"
#include "shared_scene.h"

VectorPair guided(vec3 place, vec2 u) {
    DeviceScene scene = args.scene.at[0];
    LightGuide guide = lightGuideAt(scene, place);
    float drawn = guideSky(scene, guide, u);
    vec3 w = sampleSky(scene, u).w;
    return VectorPair(vec3(drawn, inverseDensityOfGuide(scene, guide, numbersOfSky(scene, w)), guide.lights), w);
}

MAP(VectorPair, VectorPair, guided(x.a, x.b.xy))
