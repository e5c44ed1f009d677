// Textures of a scene at coordinates.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "texture.glsl"

vec4 value(TextureCase x) {
    DeviceScene scene = args.scene.at[0];
    return textureAt(scene, TexturePtr(scene.textures).at[x.texture], x.coordinates);
}

MAP(TextureCase, vec4, value(x))
