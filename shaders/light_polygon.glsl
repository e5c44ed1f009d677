// Rectangles and triangles that emit, as seen from a place: uniform over the solid angle that they fill where that
// pays. Where a light is near, its points per area bring very unequal amounts: 1 / distance^2 has no bound.
#ifndef LIGHT_POLYGON_GLSL
#define LIGHT_POLYGON_GLSL
#include "light.glsl"
#include "sampling.glsl"

// The point a + place.x u + place.y v of a rectangle or triangle.
LightPoint flatLightAt(Light light, vec2 place) {
    // A shadow ray may hit a triangle of the light anywhere along it, so all components of its place count.
    vec3 magnitude = vec3(maxComponent(abs(light.a) + abs(light.a + light.u) + abs(light.a + light.v)));
    return LightPoint(light.a + place.x * light.u + place.y * light.v, magnitude, directionOfCross(light.u, light.v));
}

// Lights whose middle is within so many of their diagonals are near. What is far is sampled by area, which there is as
// good and costs less.
const float NEAR = 2.0;

bool isNear(Light light, vec3 origin) {
    vec3 toMiddle = light.a - origin + 0.5 * (light.u + light.v);
    return dot(toMiddle, toMiddle) < NEAR * NEAR * (dot(light.u, light.u) + dot(light.v, light.v));
}

// A corner of a light as seen from a place: where it is, its direction, and one over its distance; zero at the place
// itself.
struct Corner {
    vec3 position;
    vec3 w;
    float inverseDistance;
};

Corner cornerAt(vec3 position) {
    float distance2 = dot(position, position);
    float inverseDistance = distance2 > 0.0 ? inversesqrt(distance2) : 0.0;
    return Corner(position, inverseDistance * position, inverseDistance);
}

// The sum of the directions of two corners. Where they are nearly opposite it is made of a part across the side that
// joins them and one along it, of which neither is a difference of large numbers.
vec3 sumOf(Corner a, Corner b) {
    if (dot(a.w, b.w) > -0.5) return a.w + b.w;
    vec3 side = normalize(b.position - a.position);
    vec3 across = a.position - dot(a.position, side) * side;
    vec3 q = across * a.inverseDistance, s = across * b.inverseDistance;
    return q + s + side * (dot(q - s, q + s) / dot(b.w - a.w, side));
}

// A triangle of a light as seen from a place; the side from the apex to b is that of its two sides seen under the
// larger angle.
struct SphericalTriangle {
    Corner apex;
    Corner b;
    Corner d;
    bool swapped;  // whether b and d are
    vec3 bisector; // of apex and b: the sum of their directions
    vec3 diagonal; // the same of b and d
    vec2 halfway;  // cosine and sine of half its solid angle, times the same positive number
    float angle;   // half its solid angle
};

// Half the solid angle by Van Oosterom & Strackee (1983, eq. 8); `normal` is the cross product of the triangle's sides
// in space, so that small triangles keep their digits. The cosine is written about the two corners that are the most
// opposite.
SphericalTriangle sphericalTriangle(Corner apex, Corner b, Corner d, vec3 diagonal, vec3 normal) {
    SphericalTriangle t;
    t.swapped = dot(apex.w, d.w) < dot(apex.w, b.w);
    t.apex = apex;
    t.b = t.swapped ? d : b;
    t.d = t.swapped ? b : d;
    t.bisector = sumOf(t.apex, t.b);
    t.diagonal = diagonal;
    bool across = dot(b.w, d.w) < dot(apex.w, t.b.w);
    vec3 sum = across ? diagonal : t.bisector;
    t.halfway = vec2(0.5 * dot(sum, sum) + dot(sum, across ? apex.w : t.d.w),
                     abs(dot(apex.w, normal)) * b.inverseDistance * d.inverseDistance);
    t.angle = angleAbove(t.halfway);
    return t;
}

// Weights of the corners apex, b and d, not normalized, of a point of a light's triangle: uniform over solid angle
// (Arvo 1995), without the inverse of a cosine. The arc from the apex through the point ends between b and d, and parts
// off a triangle of `part`, half its solid angle: the formula for half the angle is linear in the bisector of b and the
// arc's end, which has the weights x and x r. No weight is negative, so the point is on the light whatever rounding
// does.
vec3 sampleSphericalTriangle(SphericalTriangle t, float part, float v) {
    vec2 p = unitCircle(part / (2.0 * PI));
    float less = max(0.0, t.halfway.y * p.x - t.halfway.x * p.y);
    float x = 0.5 * dot(t.bisector, t.bisector) * p.y + less;
    float rest = x > 0.0 ? less / x : 1.0;
    float r = 1.0 - rest;
    float high = 0.5 * r * dot(t.diagonal, t.diagonal);
    vec2 end = vec2(rest * (1.0 + r), 2.0 * r * (rest + high)) / (rest * rest + 2.0 * high);

    // Uniform in the cosine along the arc; 1 - cos by the chord.
    vec3 chord = end.x * t.b.w + end.y * t.d.w - t.apex.w;
    float height = min(0.5 * dot(chord, chord), 1.9999999);
    float toEnd = sqrt(v * (2.0 - v * height) / (2.0 - height));
    vec3 weights = vec3(max(0.0, 1.0 - v * height - (1.0 - height) * toEnd), toEnd * end) *
                   vec3(t.apex.inverseDistance, t.b.inverseDistance, t.d.inverseDistance);
    return t.swapped ? weights.xzy : weights;
}

// The point of a light that has the weights, of the corner `apex` and the two beside it, `beyond` the diagonal or not;
// the light fills the solid angle.
LightSample flatSample(Light light, vec3 weights, bool beyond, float solidAngle) {
    float sum = weights.x + weights.y + weights.z;
    if (!(sum > 0.0)) return LightSample(flatLightAt(light, vec2(0.5)), 0.0);
    return LightSample(flatLightAt(light, min((weights.yz + (beyond ? weights.x : 0.0)) / sum, 1.0)),
                       solidAngle); // drivers divide to 2.5 ulps
}

#endif
