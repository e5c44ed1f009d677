// What every kernel starts with: the shared structs, its arguments, and the index of its invocation.
#ifndef COMMON_GLSL
#define COMMON_GLSL
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared.h"

layout(local_size_x = GROUP) in;

#define ARGS(T)                                                                                                        \
    layout(push_constant, scalar) uniform PushConstants { T args; };

const float PI = 3.14159265;
const float BELOW_ONE = 0.99999994;
const float GREATEST = 3.4028235e38; // of floats: compilers may take it that there are no infinities

// Index over all groups of a dispatch, which may have several rows.
uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint threadIndex() { return groupIndex() * GROUP + gl_LocalInvocationIndex; }

// Of `count` numbers that do not fall, `stride` apart from `first` on, which is the first above u; the last if none is.
uint firstAbove(uvec2 numbers, uint first, uint stride, uint count, float u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (u < floatPtr(numbers).at[first + stride * middle]) high = middle;
        else low = middle + 1u;
    }
    return low;
}

float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }

// A power of two, times which edges of any length are about as long as 1: no bit changes, and their squares stay
// numbers.
float unitScale(vec3 u, vec3 v) {
    float longest = maxComponent(max(abs(u), abs(v)));
    return uintBitsToFloat(0x7f000000u - (floatBitsToUint(longest) & 0x7f800000u));
}

// The direction of u x v.
vec3 directionOfCross(vec3 u, vec3 v) {
    float scale = unitScale(u, v);
    return normalize(cross(scale * u, scale * v));
}

// Of linear Rec. 709.
float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// Without leaning on comparisons of NaN, which drivers may assume away.
bool isFinite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

bool isFinite(vec3 v) { return isFinite(v.x) && isFinite(v.y) && isFinite(v.z); }

#endif
