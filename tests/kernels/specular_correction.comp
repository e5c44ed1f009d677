// The correction of flux for shading normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(CorrectionCase, float, specularCorrection(x.wi, x.wo, x.normal, x.geometric))
