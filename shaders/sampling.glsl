// Points on simple domains from points of the unit square.
#ifndef SAMPLING_GLSL
#define SAMPLING_GLSL
#include "common.glsl"

// The point of the unit circle at x eighths of a turn, |x| <= 1 (polynomials of Cephes, Moshier 1992). Drivers' sin and
// cos may be wrong by 2^-11, which puts directions off by more than a gather radius and points of the disc outside it.
vec2 unitCircleNear(float x) {
    float angle = PI / 4.0 * x;
    float z = angle * angle;
    float c = 1.0 - 0.5 * z + z * z * (4.166664568e-2 + z * (-1.388731625e-3 + z * 2.443315712e-5));
    float s = angle + angle * z * (-1.6666654611e-1 + z * (8.3321608736e-3 - z * 1.9515295891e-4));
    return vec2(c, s);
}

// The point of the unit circle at u turns from the x axis, u in [0, 1].
vec2 unitCircle(float u) {
    float quarters = floor(4.0 * u + 0.5);
    vec2 p = unitCircleNear(8.0 * u - 2.0 * quarters);
    uint turned = uint(quarters);
    if ((turned & 1u) != 0u) p = vec2(-p.y, p.x);
    return (turned & 2u) != 0u ? -p : p;
}

// The angle of a point from the x axis, in [0, pi]; p.y >= 0 (polynomial of Cephes, Moshier 1992). Drivers' atan may be
// off by 4096 ulps.
float angleAbove(vec2 p) {
    float x = abs(p.x);
    float high = max(x, p.y);
    float t = high > 0.0 ? min(x, p.y) / high : 0.0;
    bool wide = t > 0.41421356;
    if (wide) t = (t - 1.0) / (t + 1.0);
    float z = t * t;
    float angle =
        t + t * z * (-3.33329491539e-1 + z * (1.99777106478e-1 + z * (-1.38776856032e-1 + z * 8.05374449538e-2)));
    if (wide) angle += PI / 4.0;
    if (p.y > x) angle = PI / 2.0 - angle;
    return p.x < 0.0 ? PI - angle : angle;
}

// A point of the unit disc, uniform over area (Shirley & Chiu 1997).
vec2 uniformDisc(vec2 u) {
    vec2 p = 2.0 * u - 1.0;
    if (p.x == 0.0 && p.y == 0.0) return vec2(0.0);
    bool wide = abs(p.x) > abs(p.y);
    vec2 q = wide ? p : p.yx;
    vec2 result = q.x * unitCircleNear(q.y / q.x);
    return wide ? result : result.yx;
}

// A direction about +z with density cos / pi over solid angle (Malley).
vec3 cosineHemisphere(vec2 u) {
    vec2 p = uniformDisc(u);
    return vec3(p, sqrt(max(0.0, 1.0 - dot(p, p))));
}

// A direction of the unit sphere with density 1 / (4 pi) over solid angle.
vec3 uniformSphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = 2.0 * sqrt(u.x * (1.0 - u.x));
    return vec3(r * unitCircle(u.y), z);
}

// 1 - cos of the half angle under which a sphere at distance sqrt(distance2) > radius is seen; no cancellation.
float coneHeight(float radius, float distance2) {
    float sin2 = radius * radius / distance2;
    return sin2 / (1.0 + sqrt(max(0.0, 1.0 - sin2)));
}

// A direction within a cone about +z, uniform over solid angle; `height` is 1 - cos of its half angle.
vec3 uniformCone(vec2 u, float height) {
    float h = u.x * height;
    float r = sqrt(h * (2.0 - h));
    return vec3(r * unitCircle(u.y), 1.0 - h);
}

// Weights of the second and third vertex of a triangle, uniform over area.
vec2 uniformTriangle(vec2 u) {
    float s = sqrt(u.x);
    return vec2(s * (1.0 - u.y), s * u.y);
}

#endif
