// Directions toward all that light falls upon, and their weights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "sampling.glsl"
#include "frame.glsl"
#include "light.glsl"
#include "features.glsl"
#include "targets.glsl"

vec4 aim(AimCase x) {
    vec3 direction;
    float weight = aimAtLit(args.scene.at[0], LightPoint(x.position, vec3(0.0), x.normal), x.u, direction);
    return vec4(direction, weight);
}

MAP(AimCase, vec4, aim(x))
