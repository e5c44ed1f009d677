// Spheres that emit.
#ifndef LIGHT_SPHERE_GLSL
#define LIGHT_SPHERE_GLSL
#include "directions.glsl"
#include "light.glsl"
#include "sampling.glsl"

// A point uniform over area.
LightPoint emitSphere(Light light, vec2 u) {
    vec3 n = uniformSphere(u);
    return LightPoint(light.a + light.u.x * n, abs(light.a) + light.u.x, n);
}

// Seen from outside: uniform over the cone that it fills (Shirley, Wang & Zimmerman 1996). The point is the nearer one
// on the ray of that direction, put back onto the sphere.
LightSample sampleSphereOutside(Light light, vec3 origin, vec2 u) {
    vec3 toCenter = light.a - origin;
    float distance2 = dot(toCenter, toCenter);
    float radius = light.u.x;
    float height = coneHeight(radius, distance2);
    vec3 w = toWorld(uniformCone(u, height), toCenter * inversesqrt(distance2));
    float along = dot(toCenter, w);
    vec3 across = toCenter - along * w;
    vec3 n = normalize(-across - sqrt(max(0.0, radius * radius - dot(across, across))) * w);
    return LightSample(LightPoint(light.a + radius * n, abs(light.a) + radius, n), 2.0 * PI * height);
}

LightSample sampleSphere(Light light, vec3 origin, vec2 u) {
    vec3 toCenter = light.a - origin;
    if (dot(toCenter, toCenter) > light.u.x * light.u.x) return sampleSphereOutside(light, origin, u);
    return sampleByArea(light, emitSphere(light, u), origin);
}

// The solid angle that a point of the light stands for among the samples from `origin`: one over their density.
float inversePdfSphere(Light light, vec3 origin, LightPoint point) {
    vec3 toCenter = light.a - origin;
    float distance2 = dot(toCenter, toCenter);
    if (distance2 > light.u.x * light.u.x) return 2.0 * PI * coneHeight(light.u.x, distance2);
    return inversePdfByArea(light, point.normal, point.position - origin);
}

#endif
