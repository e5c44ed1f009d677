// Local frames, and unit vectors in 32 bits.
#ifndef DIRECTIONS_GLSL
#define DIRECTIONS_GLSL
#include "common.glsl"

// A vector given about +z, turned to be about the unit vector n (Duff et al. 2017).
vec3 toWorld(vec3 v, vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    return v.x * tangent + v.y * bitangent + v.z * n;
}

// Octahedral code of a unit vector, 16 bits a coordinate (Meyer et al. 2010).
uint packUnit(vec3 v) {
    vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    if (v.z < 0.0) p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    uvec2 q = uvec2(ivec2(round(p * 32767.0)) + 32767);
    return q.x | q.y << 16;
}

// The direction of the unit vector, of any length.
vec3 unpackDirection(uint code) {
    vec2 p = vec2(ivec2(code & 0xffffu, code >> 16) - 32767);
    vec3 v = vec3(p, 32767.0 - abs(p.x) - abs(p.y));
    if (v.z < 0.0) v.xy = (32767.0 - abs(v.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(v.xy, vec2(0.0)));
    return v;
}

vec3 unpackUnit(uint code) { return normalize(unpackDirection(code)); }

#endif
