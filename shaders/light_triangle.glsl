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

// The solid angle that a point of the light stands for among the samples from `origin`: one over their density.
float inversePdfTriangle(Light light, vec3 origin, LightPoint point) {
    if (!isNear(light, origin)) return inversePdfByArea(light, point.normal, point.position - origin);
    vec3 toA = light.a - origin;
    Corner b = cornerAt(toA + light.u), d = cornerAt(toA + light.v);
    return 2.0 * sphericalTriangle(cornerAt(toA), b, d, sumOf(b, d), cross(light.u, light.v)).angle;
}

#endif
