// Directions toward all that light falls upon, and their weights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "light.glsl"
#include "projection_map.glsl"

vec4 aimed(AimCase x) {
    Aim aim = aimAtLit(args.scene.at[0], LightPoint(x.position, vec3(0.0), x.normal), x.u);
    return vec4(aim.direction, aim.weight);
}

MAP(AimCase, vec4, aimed(x))
