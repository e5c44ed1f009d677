// Textures as kernels read them.
#ifndef SHARED_TEXTURES_H
#define SHARED_TEXTURES_H
#include "shared.h"

SHARED_BEGIN

// What a texel is in DeviceScene.texels: a word, red in its low byte and alpha in its high one, or four floats.
const uint TEXELS_SRGB = 0u; // red, green and blue by the curve of sRGB
const uint TEXELS_LINEAR = 1u;
const uint TEXELS_FLOAT = 2u;
// At the begin of DeviceScene.texels: what bytes stand for, by the curve of sRGB and linear.
const uint TEXEL_TABLE = 256u;

struct TexelImage {
    uint first; // word of DeviceScene.texels
    uint width;
    uint height;
    uint format; // TEXELS_...
};
BUFFER(TexelImage)

// How a texture goes on beyond its image.
const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRROR = 1u;
const uint WRAP_CLAMP = 2u;

/// An image on surfaces: at the coordinates (s, t) of a surface it is looked up at (dot(u, (s, t, 1)), dot(v, ...)),
/// where (0, 0) is the corner before its first texel and (1, 1) that behind its last one.
struct Texture {
    uint image;   // index into DeviceScene.images
    uint set;     // of coordinates: 0 or 1
    uint wrapU;   // WRAP_...
    uint wrapV;   //
    uint nearest; // 1: no filter
    uint channel; // of numbers
    vec3 factor;
    vec3 u;
    vec3 v;
};
BUFFER(Texture)

/// Where a light's texture lies on it: coordinates at its corner a, and along u and v. Spheres have latitudes.
struct LightTexture {
    uint texture;
    vec2 a;
    vec2 u;
    vec2 v;
};
BUFFER(LightTexture)

/// Textures of a material, indices into DeviceScene.textures or NONE.
struct MaterialTextures {
    uint color;
    uint metallic;
    uint roughness;
    uint opacity;
    uint normal; // its factor is (strength, strength, 1)
    uint specular;
    uint specularColor; // its factor has the reflectance by the index, too
    uint transmission;
    uint colors; // 1: its color is multiplied by those of vertices
};
BUFFER(MaterialTextures)

/// TexturePlaces of the corners of a triangle; v goes up.
struct TexturePlaces {
    vec2 a;
    vec2 b;
    vec2 c;
};
BUFFER(TexturePlaces)

/// Colours of the corners of a triangle, linear.
struct VertexColors {
    vec3 a;
    vec3 b;
    vec3 c;
};
BUFFER(VertexColors)

/// Tangents of the corners of a triangle, along which red of a normal map turns normals, on its side with the sign
/// `side` of the direction of green: that of cross(normal, tangent), or against it. All are 0 where the mesh gives
/// none.
struct Tangents {
    vec3 a;
    vec3 b;
    vec3 c;
    float side;
};
BUFFER(Tangents)

// Rows of DeviceScene.rests of a lobe whose roughness is a texture: at roughnesses i / ROUGHNESS_STEPS.
const uint ROUGHNESS_STEPS = 32u;

SHARED_END
#endif
