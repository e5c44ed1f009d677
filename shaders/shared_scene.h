// A scene as kernels read it.
#ifndef SHARED_SCENE_H
#define SHARED_SCENE_H
#include "shared.h"
#include "shared_kinds.h"
#include "shared_sky.h"
#include "shared_textures.h"

SHARED_BEGIN

/// A bounding volume hierarchy node with the boxes of its two children packed in the parent.
/// A child is the index of a node, or LEAF | (count - 1) << LEAF_SHIFT | first slot of `leaves`;
/// a missing child has an inverted box.
struct Node {
    vec3 leftLow;
    vec3 leftHigh;
    vec3 rightLow;
    vec3 rightHigh;
    uint left;
    uint right;
};
const uint LEAF = 0x80000000u;
const uint LEAF_SHIFT = 27u;
const uint LEAF_FIRST = 0x07ffffffu;
BUFFER(Node)

/// A primitive as traversal reads it, in the order of the leaves:
/// a triangle a, b, c, or, if id >= DeviceScene.triangleCount, the sphere of centre a and radius b.x, whose point next
/// to the origin of coordinates is c.
struct Leaf {
    vec3 a;
    vec3 b;
    vec3 c;
    uint id;
};
BUFFER(Leaf)

/// A triangle's Leaf by the components of its vertices.
struct LeafNumbers {
    float a[3];
    float b[3];
    float c[3];
    uint id;
};
BUFFER(LeafNumbers)

/// A primitive as shading reads it, in the order of the scene: triangles first, then spheres.
/// A triangle's geometric normal is that of (b - a) x (c - a); a sphere's points outward.
struct Primitive {
    vec3 a;
    vec3 b;
    vec3 c;
    uint material;
    uint light;   // index into `lights`, or NONE
    uint normals; // index into `normals`, or NONE for a flat triangle or a sphere
};
BUFFER(Primitive)

/// Unit shading normals at the three vertices of a triangle.
struct Normals {
    vec3 a;
    vec3 b;
    vec3 c;
};
BUFFER(Normals)

struct Material {
    uint kind;    // MATERIAL_...
    vec3 color;   // albedo, reflectance (of metal at normal incidence), or factor at each refraction, within [0, 1]
    float ior;    // glass: index inside / index outside; plastic: of its coat
    uint schlick; // glass: 1 for Schlick's reflectance in place of the exact one
    float alpha;  // of a glossy lobe: roughness^2
    uint rest;    // of a glossy lobe and a diffuse one: row of DeviceScene.rests; NONE: the diffuse one is left out
    vec3 normalIncidence; // standard: reflectance of its dielectric at normal incidence
    float grazing;        // and at grazing incidence
    float metallic;       // standard: how much of it is metal
    uint textures;        // 0, or 1 + index into DeviceScene.materialTextures
    float restFraction;   // how far on to the row of the next roughness `rest` is
    float seeThrough;     // 1 - opacity; 1 where that is a texture
    float cutoff;         // > 0: what is less opaque is not there, all else whole
    uint medium;          // glass: what it is filled with, index into DeviceScene.media
    uint exterior;        // glass: what is outside of it, likewise; NONE: what a path was in
    vec2 spread;          // glass: what is added to `ior` for red and for blue
    uint wide;            // of its glossy lobe, WIDE_...; 0: the label is not W
    uint base;            // glass: 0, or 1 + index of the standard material that is there in its place by chance
    float transmission;   // standard: 1 - this stands for what its dielectric has of that chance
};
BUFFER(Material)

// Of glossy lobes that are as wide as a few diffuse ones: from this alpha on, photons and light samples count them
// among diffuse ones, and rays bring what they reflect. Where roughness is a texture, the greatest decides.
const float WIDE_ALPHA = 0.25f;
const uint WIDE_BY_RAYS = 1u, WIDE_BY_PHOTONS = 2u; // by which caustics that fall on it are found

/// What glass is filled with. The first of DeviceScene.media is what all of it stands in: clear, of index 1.
struct Medium {
    vec3 attenuation; // light falls to 2^-(attenuation x way)
    float ior;        // for green
    vec2 spread;      // what is added to it for red and for blue
    uint priority;    // where glass overlaps, the highest counts; of equals, that which was entered last
};
BUFFER(Medium)

const uint MEDIUM_BITS = 8u; // a path knows the four media that it is in: those that count first in the lowest bits
const uint MAX_MEDIA = 1u << MEDIUM_BITS;

// What a glossy lobe leaves to the diffuse one, 1 - E(cos) where E is what the glossy one reflects: a row has the
// values at cosines (i / (REST_STEPS))^2, then the mean by the cosine law. Standard materials have two rows: for
// reflectances of 0 and of 1 at normal incidence, between which 1 - E is linear.
const uint REST_STEPS = 32u;
const uint REST_MEAN = REST_STEPS + 1u;
const uint REST_ROW = REST_STEPS + 2u;

const float LEAST_ALPHA = 1e-3f; // of lobes: in 32-bit floats, nothing is left of the density of narrower ones

/// A light. Area lights emit `radiance` on the side of their normal, or on both.
struct Light {
    vec3 a;
    vec3 u;
    vec3 v;
    vec3 radiance;
    uint kind; // LIGHT_...; it says what a, u and v are
    uint twoSided;
    float area;     // of lights without one, flux over pi times radiance
    float share;    // of all flux, over the probability by DeviceScene.lightCdf: nearly 1
    uint texture;   // 0, or 1 + index into DeviceScene.lightTextures; then `radiance` is about its mean
    uint primitive; // of an area light, or the first of two
};
BUFFER(Light)

/// A sphere at which photons are aimed: those of caustics at that about a specular shape, those of far lights at that
/// about all that light falls upon.
struct Target {
    vec3 center;
    float radius;
};
BUFFER(Target)

/// A box of numbers that choose what to sample, cut in the middle of an axis into children `child` (lower numbers) and
/// `child` + 1. In a light guide regions of space come first, which are cut anywhere.
struct GuideNode {
    uint axis;   // NONE: a leaf
    float lower; // part of the samples of the box that the lower half gets; of space, where it is cut
    uint child;
};
BUFFER(GuideNode)
const uint LIGHT_GUIDE_REGION = 3u; // axis of a region that is not cut: `child` is the root of its tree over numbers,
                                    // `lower` the index of its first light in DeviceScene.directCdf

/// A camera; through the middle of its lens the ray of film position (x, y) in [0, 1]^2, y down, has the direction
/// forward + (2 x - 1) right + (1 - 2 y) up, where |right| and |up| are the tangents of the half angles.
struct Camera {
    vec3 origin;
    vec3 forward;
    vec3 right;
    vec3 up;
    float aperture; // radius of its lens: 0 of a pinhole
    float focus;    // how far the plane is that is sharp, along the axis
};

/// Addresses of the arrays of a scene; what a scene lacks has address 0.
struct DeviceScene {
    ADDRESS(Node) nodes;
    ADDRESS(Leaf) leaves;
    ADDRESS(Primitive) primitives;
    ADDRESS(Normals) normals;
    ADDRESS(Material) materials;
    ADDRESS(Light) lights;
    ADDRESS(float) lightCdf;       // of photons: upper ends, the last is 1
    ADDRESS(float) directCdf;      // of light samples, likewise; then those of regions, see light_guide.glsl
    ADDRESS(GuideNode) lightGuide; // see light_guide.glsl
    ADDRESS(Target) targets;
    ADDRESS(float) targetWeights; // by which targets are chosen, times their solid angle; of layered materials alone
    ADDRESS(float) rests;         // rows of REST_ROW numbers
    ADDRESS(Medium) media;
    ADDRESS(uint) lightMedia; // by light, of paths that start before it and behind it
    ADDRESS(uint) touching; // by triangle, where the list of those that may lie on it begins, here too; then the lists
    ADDRESS(Sky) sky;
    ADDRESS(MaterialTextures) materialTextures;
    ADDRESS(LightTexture) lightTextures;
    ADDRESS(Texture) textures;
    ADDRESS(TexelImage) images;
    ADDRESS(uint) texels;               // tables, then words of images, see TexelImage
    ADDRESS(TexturePlaces) coordinates; // of all triangles in the order of primitives, one set after the other
    ADDRESS(VertexColors) colors;       // of all triangles
    ADDRESS(Tangents) tangents;         // likewise
    ADDRESS(uint) missing;   // a bit for each feature that a kernel needed and was without, if checksFeatures
    ADDRESS(uint) overflows; // how often a path was in more than four media
    Target lit;              // about all that light falls upon
    Target near;             // about all but far lights
    Target middle;           // of what is lit, leaving out few shapes that are much larger
    uint triangleCount;
    uint lightCount;
    uint endlessCount; // of the first lights
    uint discCount;    // across directions from endlessly far: the middle's, each four times as wide, and that of `lit`
    uint targetCount;
    uint coordinateSets;
    float unit;       // of lengths, in world units: a power of two
    uint cameraMedia; // of paths that start at the camera
    Camera camera;
};
BUFFER(DeviceScene)

SHARED_END
#endif
