// Triangles that emit.
#ifndef LIGHT_TRIANGLE_GLSL
#define LIGHT_TRIANGLE_GLSL
#include "light_polygon.glsl"

// A point uniform over area.
LightPoint emitTriangle(Light light, vec2 u) { return flatLightAt(light, uniformTriangle(u)); }

LightSample sampleTriangle(Light light, vec3 origin, vec2 u) {
    if (!isNear(light, origin)) return sampleByArea(light, emitTriangle(light, u), origin);
    vec3 toA = light.a - origin;
    Corner b = cornerAt(toA + light.u), d = cornerAt(toA + light.v);
    SphericalTriangle t = sphericalTriangle(cornerAt(toA), b, d, sumOf(b, d), cross(light.u, light.v));
    return flatSample(light, sampleSphericalTriangle(t, u.x * t.angle, u.y), false, 2.0 * t.angle);
}

#endif
