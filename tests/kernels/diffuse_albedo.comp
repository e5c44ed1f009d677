// The albedo of a diffuse lobe about +z, whose rows a scene has.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "material.glsl"

MAP(GlossyCase, vec3, diffuseAlbedo(args.scene.at[0], x.material, x.wo.z))
