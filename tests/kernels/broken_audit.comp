// An audit kernel on a driver that computes nothing: every result is 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_audit.h"

ARGS(AuditArgs)

void main() {
    if (threadIndex() < args.count) args.results.at[threadIndex()] = 1u;
}
