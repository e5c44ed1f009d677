// Surfaces at hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "surface.glsl"

SurfaceValues values(Surface s) {
    return SurfaceValues(s.position, s.magnitude, s.normal, s.shading, s.material, s.light);
}

MAP(SurfaceCase, SurfaceValues, values(surfaceAt(args.scene.at[0], x.path, x.hit)))
