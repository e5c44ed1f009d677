// Points on simple domains from points of the unit square.

// A point of the unit disc, uniform over area (Shirley & Chiu 1997).
vec2 uniformDisc(vec2 u) {
    vec2 p = 2.0 * u - 1.0;
    if (p.x == 0.0 && p.y == 0.0) return vec2(0.0);
    bool wide = abs(p.x) > abs(p.y);
    float radius = wide ? p.x : p.y;
    float angle = wide ? (PI / 4.0) * (p.y / p.x) : (PI / 2.0) - (PI / 4.0) * (p.x / p.y);
    return radius * vec2(cos(angle), sin(angle));
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
    float phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), z);
}

// A direction within a cone about +z, uniform over solid angle; `height` is 1 - cos of its half angle.
vec3 uniformCone(vec2 u, float height) {
    float h = u.x * height;
    float r = sqrt(h * (2.0 - h));
    float phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), 1.0 - h);
}

// Weights of the second and third vertex of a triangle, uniform over area.
vec2 uniformTriangle(vec2 u) {
    float s = sqrt(u.x);
    return vec2(s * (1.0 - u.y), s * u.y);
}
