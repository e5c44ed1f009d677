// The materials of a scene at hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

Material value(SurfaceCase x) {
    DeviceScene scene = args.scene.at[0];
    return materialAt(scene, x.path, surfaceAt(scene, x.path, x.hit), x.hit.weights);
}

MAP(SurfaceCase, Material, value(x))
