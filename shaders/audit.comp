// Small computations with known results; see host/gpu/audit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_audit.h"

ARGS(AuditArgs)

shared uint exchange[GROUP];

uint longLoop(uint trips) {
    uint sum = 0u;
    for (uint i = 0u; i < trips; i++) sum += i % 7u;
    return sum;
}

// A number that the compiler does not know.
float opaque(float x) { return uintBitsToFloat(floatBitsToUint(x) + (args.trips == 0u ? 1u : 0u)); }

uint floats(uint index) {
    float large = opaque(3.0e38);
    if (index == 0u) return floatBitsToUint(large * opaque(10.0));
    if (index == 1u) return floatBitsToUint(large * opaque(-10.0));
    if (index == 2u) return floatBitsToUint((opaque(16777216.0) + opaque(1.0)) - opaque(16777215.0));
    return floatBitsToUint(opaque(1.17549435e-38));
}

uint result(uint index) {
    switch (args.test) {
    case AUDIT_LOOP:
        return longLoop(args.trips) + index;
    case AUDIT_DIVERGENT:
        return longLoop(args.trips - 16u * index);
    case AUDIT_SHARED:
        return exchange[GROUP - 1u - gl_LocalInvocationIndex] * 3u + 1u;
    default:
        return floats(index);
    }
}

void main() {
    uint index = threadIndex();
    if (args.test == AUDIT_WIDE) { // one result a group
        if (groupIndex() < args.count && gl_LocalInvocationIndex == GROUP - 1u)
            args.results.at[groupIndex()] = index ^ 0x5bd1e995u;
        return;
    }
    exchange[gl_LocalInvocationIndex] = index;
    barrier();
    if (index < args.count) args.results.at[index] = result(index);
}
