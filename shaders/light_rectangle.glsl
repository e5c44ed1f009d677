// Rectangles that emit.
#ifndef LIGHT_RECTANGLE_GLSL
#define LIGHT_RECTANGLE_GLSL
#include "light_polygon.glsl"

// A point uniform over area.
LightPoint emitRectangle(Light light, vec2 u) { return flatLightAt(light, u); }

// Two triangles on one diagonal, chosen by u.x.
LightSample sampleRectangle(Light light, vec3 origin, vec2 u) {
    if (!isNear(light, origin)) return sampleByArea(light, emitRectangle(light, u), origin);
    vec3 toA = light.a - origin;
    vec3 normal = cross(light.u, light.v);
    Corner b = cornerAt(toA + light.u), d = cornerAt(toA + light.v);
    vec3 diagonal = sumOf(b, d);
    SphericalTriangle t = sphericalTriangle(cornerAt(toA), b, d, diagonal, normal);
    SphericalTriangle other = sphericalTriangle(cornerAt(toA + light.u + light.v), b, d, diagonal, normal);
    float first = t.angle, whole = t.angle + other.angle;
    float part = u.x * whole;
    bool beyond = part >= first;
    if (beyond) {
        t = other;
        part = min(part - first, other.angle);
    }
    return flatSample(light, sampleSphericalTriangle(t, part, u.y), beyond, 2.0 * whole);
}

// The solid angle that a point of the light stands for among the samples from `origin`: one over their density.
float inversePdfRectangle(Light light, vec3 origin, LightPoint point) {
    if (!isNear(light, origin)) return inversePdfByArea(light, point.normal, point.position - origin);
    vec3 toA = light.a - origin;
    vec3 normal = cross(light.u, light.v);
    Corner b = cornerAt(toA + light.u), d = cornerAt(toA + light.v);
    vec3 diagonal = sumOf(b, d);
    return 2.0 * (sphericalTriangle(cornerAt(toA), b, d, diagonal, normal).angle +
                  sphericalTriangle(cornerAt(toA + light.u + light.v), b, d, diagonal, normal).angle);
}

#endif
