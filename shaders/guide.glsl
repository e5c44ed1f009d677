// Guided emission: numbers that start photons, by a tree that says how many to draw from each part of their unit cube
// (primary sample space path guiding by trees, Guo, Bauszat, Bikker & Eisemann 2018).
#ifndef GUIDE_GLSL
#define GUIDE_GLSL
#include "common.glsl"
#include "random.glsl"
#include "shared_photons.h"

// The numbers that start a photon, uniform over the unit cube.
float[PRIMARY_DIMENSIONS] primarySample(Sampler s) {
    vec2 light = sample2(s, 0u);
    vec2 place = sample2(s, 1u);
    vec2 direction = sample2(s, 2u);
    return float[](light.x, light.y, place.x, place.y, direction.x, direction.y, sample2(s, 3u).x);
}

// Warps uniform numbers to those of the guide's density; returns the uniform density over that. Numbers that were well
// distributed stay so, as each half of a box keeps their order (as McCool & Harwood 1997 do for grids).
float guide(GuideNodePtr nodes, inout float numbers[PRIMARY_DIMENSIONS]) {
    float low[PRIMARY_DIMENSIONS] = float[](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    float width[PRIMARY_DIMENSIONS] = float[](1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
    float inverseDensity = 1.0;
    GuideNode node = nodes.at[0];
    while (node.axis != NONE) {
        uint axis = node.axis;
        float x = numbers[axis];
        bool upper = x >= node.lower;
        float part = upper ? 1.0 - node.lower : node.lower;
        numbers[axis] = min((upper ? x - node.lower : x) / part, BELOW_ONE);
        width[axis] *= 0.5;
        if (upper) low[axis] += width[axis];
        inverseDensity *= 0.5 / part;
        node = nodes.at[node.child + uint(upper)];
    }
    [[unroll]] for (uint i = 0u; i < PRIMARY_DIMENSIONS; i++) numbers[i] =
        min(low[i] + width[i] * numbers[i], BELOW_ONE);
    return inverseDensity;
}

#endif
