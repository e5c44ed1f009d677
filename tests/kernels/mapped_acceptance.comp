// Events about mapped normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "normal_map.glsl"

float acceptance(CorrectionCase x) {
    Surface surface; // of which the acceptance reads the normals alone
    surface.normal = x.geometric;
    surface.shading = x.normal;
    return mappedAcceptance(surface, x.wi, x.wo);
}

MAP(CorrectionCase, float, acceptance(x))
