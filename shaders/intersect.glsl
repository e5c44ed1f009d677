// Rays against boxes, triangles and spheres; a hit has t > 0 and t at most that of the hit so far.
#ifndef INTERSECT_GLSL
#define INTERSECT_GLSL
#include "common.glsl"
#include "sphere.glsl"

// A ray with what its tests need; `direction` need not be of unit length.
struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse;  // of the direction, finite
    vec3 shear;    // Woop's S: direction's two minor components over the major one, and 1 / major
    uvec3 axes;    // minor, minor, and that of the largest component of the direction, in cyclic order
    vec3 permuted; // origin in the order of the axes
};

// Puts the major axis last; a cyclic exchange, so that orientation stays.
vec3 permute(vec3 v, uint major) { return major == 2u ? v : major == 0u ? v.yzx : v.zxy; }

Ray makeRay(vec3 origin, vec3 direction) {
    const float tiny = 7.888609e-31; // 2^-100: keeps 0 times infinity out of the boxes
    vec3 a = abs(direction);
    uint axis = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    vec3 p = permute(direction, axis);
    vec3 safe = mix(direction, vec3(tiny), lessThan(a, vec3(tiny)));
    uvec3 axes = axis == 2u ? uvec3(0u, 1u, 2u) : axis == 0u ? uvec3(1u, 2u, 0u) : uvec3(2u, 0u, 1u);
    return Ray(origin, direction, 1.0 / safe, vec3(p.xy, 1.0) / p.z, axes, permute(origin, axis));
}

// Where a ray enters a box, or GREATEST if it misses it within (0, tMax]; conservative (Ize 2013). Numbers that are not
// negative are in the order of their bits, and integers want no care for NaN: for this a driver may need three
// instructions a comparison. Where a number is negative the box ends behind the ray, and so it stays whichever of them
// is taken.
float intersectBox(Ray ray, vec3 low, vec3 high, float tMax) {
    bvec3 backwards = lessThan(ray.inverse, vec3(0.0));
    ivec3 near = floatBitsToInt((mix(low, high, backwards) - ray.origin) * ray.inverse);
    ivec3 far = floatBitsToInt((mix(high, low, backwards) - ray.origin) * ray.inverse);
    float enter = intBitsToFloat(max(max(near.x, near.y), max(near.z, 0)));
    float leave = intBitsToFloat(min(min(far.x, far.y), min(far.z, floatBitsToInt(tMax)))) * 1.0000008;
    return enter <= leave ? enter : GREATEST;
}

// Watertight (Woop, Benthin & Wald 2013): neighbours compute a shared edge from the same products,
// so `precise` matters, and points on an edge belong to both. Returns t, or -1; weights of b and c. The vertices'
// components are in the order of the ray's axes.
float intersectPermuted(Ray ray, vec3 a, vec3 b, vec3 c, out vec2 weights) {
    precise vec3 pa = a - ray.permuted;
    precise vec3 pb = b - ray.permuted;
    precise vec3 pc = c - ray.permuted;
    precise vec2 qa = pa.xy - ray.shear.xy * pa.z;
    precise vec2 qb = pb.xy - ray.shear.xy * pb.z;
    precise vec2 qc = pc.xy - ray.shear.xy * pc.z;

    precise float u = qc.x * qb.y - qc.y * qb.x;
    precise float v = qa.x * qc.y - qa.y * qc.x;
    precise float w = qb.x * qa.y - qb.y * qa.x;
    bool outside = min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0;
    precise float determinant = u + v + w;
    if (outside || determinant == 0.0) return -1.0;

    precise float t = (u * pa.z + v * pb.z + w * pc.z) * ray.shear.z / determinant;
    weights = vec2(v, w) / determinant;
    return t;
}

float intersectTriangle(Ray ray, vec3 a, vec3 b, vec3 c, out vec2 weights) {
    uint major = ray.axes.z;
    return intersectPermuted(ray, permute(a, major), permute(b, major), permute(c, major), weights);
}

// Both roots, the nearer one first, or -1 twice; `pole` is the sphere's point next to the origin of coordinates. For
// origins within two radii of the centre the power of the origin leaves no cancellation that matters; for those farther
// away, to which the sphere is small, the discriminant comes from the distance of the line to the centre. The roots are
// without cancellation (Haines et al. 2019).
vec2 sphereRoots(Ray ray, vec3 center, float radius, vec3 pole) {
    vec3 f = ray.origin - center;
    float a = dot(ray.direction, ray.direction);
    float distance2 = dot(f, f);
    bool isNear = distance2 < 4.0 * radius * radius;
    float b = -(dot(ray.origin - pole, ray.direction) + dot(pole - center, ray.direction));
    float power = spherePower(ray.origin, center, pole);
    vec3 closest = f + (b / a) * ray.direction;
    float discriminant = isNear ? b * b - a * power : a * (radius * radius - dot(closest, closest));
    if (discriminant < 0.0) return vec2(-1.0);
    float distance = sqrt(distance2);
    float c = isNear ? power : (distance - radius) * (distance + radius);
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant);
    float near = min(c / q, q / a);
    float far = max(c / q, q / a);
    return q == 0.0 ? vec2(-1.0) : vec2(near, far);
}

// The nearer root that is > 0, or -1.
float intersectSphere(Ray ray, vec3 center, float radius, vec3 pole) {
    vec2 roots = sphereRoots(ray, center, radius, pole);
    return roots.x > 0.0 ? roots.x : roots.y > 0.0 ? roots.y : -1.0;
}

#endif
