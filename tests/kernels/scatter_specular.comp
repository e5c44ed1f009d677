// Specular scattering.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"
#include "surface.glsl"

ScatterValues scatter(ScatterCase x) {
    Surface surface; // of which scattering reads the normals alone
    surface.normal = x.normal;
    surface.shading = x.shading;
    surface.mapped = false;
    Scattering s = scatterDelta(x.material, surface, x.direction, x.u);
    return ScatterValues(s.direction, s.weight, s.normal, s.radianceScale);
}

MAP(ScatterCase, ScatterValues, scatter(x))
