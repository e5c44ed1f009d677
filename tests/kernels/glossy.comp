// A glossy lobe about +z: a sample of it by numbers, and its value and density for two directions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

GlossyValues glossy(GlossyCase x) {
    const vec3 n = vec3(0.0, 0.0, 1.0);
    Scattering s = sampleGlossy(x.material, -x.wo, n, false, vec3(x.choice, x.u));
    return GlossyValues(s.direction, s.weight, s.pdf, evaluateGlossy(x.material, false, n, x.wo, x.wi),
                        pdfGlossy(x.material, false, n, x.wo, x.wi));
}

MAP(GlossyCase, GlossyValues, glossy(x))
