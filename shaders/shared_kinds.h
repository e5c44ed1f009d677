// Kinds of materials and lights: the lists that C++ and GLSL read. A new kind is a line here and a file,
// bsdf_<kind>.glsl or light_<kind>.glsl.
#ifndef SHARED_KINDS_H
#define SHARED_KINDS_H
#include "shared.h"

SHARED_BEGIN

// Lobes: parts of the light that a surface scatters. Each event of a path has the label of the lobe that it took.
const uint LOBE_DIFFUSE = 1u; // D: photons are gathered there
const uint LOBE_DELTA = 2u;   // S: light goes on in one direction
const uint LOBE_GLOSSY = 4u;  // G: about one direction, or W, where the lobe is wide: see Material.wide

// id, constant, name of functions, lobes that it may have, in words
#define MATERIALS(X)                                                                                                   \
    X(0, DIFFUSE, Diffuse, LOBE_DIFFUSE, "diffuse surfaces") /* Lambert, both sides */                                 \
    DELTA_MATERIALS(X)                                                                                                 \
    GLOSSY_MATERIALS(X)

// Those that send light in one direction.
#define DELTA_MATERIALS(X)                                                                                             \
    X(1, MIRROR, Mirror, LOBE_DELTA, "mirrors")                /* perfect, both sides */                               \
    X(2, GLASS, Glass, LOBE_DELTA, "glass")                    /* smooth, its inside against the normal */             \
    X(8, THIN_GLASS, ThinGlass, LOBE_DELTA, "sheets of glass") /* smooth on both sides */

// Those with a glossy lobe, which light samples meet too.
#define GLOSSY_MATERIALS(X)                                                                                            \
    X(4, METAL, Metal, LOBE_GLOSSY | LOBE_DIFFUSE, "rough metal")                                                      \
    X(5, PLASTIC, Plastic, LOBE_GLOSSY | LOBE_DIFFUSE, "plastic")                                                      \
    X(6, ROUGH_GLASS, RoughGlass, LOBE_GLOSSY, "rough glass")                                                          \
    X(7, STANDARD, Standard, LOBE_GLOSSY | LOBE_DIFFUSE, "standard materials") /* glTF's metallic-roughness */         \
    X(9, ROUGH_THIN_GLASS, RoughThinGlass, LOBE_GLOSSY, "rough sheets of glass")

// id, constant, name of functions, in words
#define LIGHTS(X)                                                                                                      \
    AREA_LIGHTS(X)                                                                                                     \
    DELTA_LIGHTS(X)                                                                                                    \
    ENDLESS_LIGHTS(X)

#define AREA_LIGHTS(X)                                                                                                 \
    X(0, RECTANGLE, Rectangle, "rectangles that emit") /* a + x u + y v, x and y in [0, 1]; normal u x v */            \
    X(1, TRIANGLE, Triangle, "meshes that emit")       /* a, a + u, a + v; normal u x v */                             \
    X(2, SPHERE, Sphere, "spheres that emit")          /* centre a, radius u.x; normal outward */

// Without a size, so that no ray finds them; their radiance is an intensity.
#define DELTA_LIGHTS(X)                                                                                                \
    X(3, POINT, Point, "lights that are points") /* at a */                                                            \
    X(4, SPOT, Spot, "spot lights")              /* at a, towards u; v: see beam() in light_delta.glsl */

// So far away that they are in the same direction from everywhere; the first of a scene's lights.
#define ENDLESS_LIGHTS(X)                                                                                              \
    X(5, SUN, Sun, "suns")             /* towards a; u: sine of half its angle, 1 - cosine */                          \
    X(6, SKY, Sky, "light from a sky") /* DeviceScene.sky */

#define X(id, NAME, name, lobes, words) const uint MATERIAL_##NAME = id;
MATERIALS(X)
#undef X
#define X(id, NAME, name, words) const uint LIGHT_##NAME = id;
LIGHTS(X)
#undef X

// Bits of the kinds of materials that may have a lobe.
#define X(id, NAME, name, lobes, words) | (((lobes)&LOBE_DIFFUSE) != 0u ? 1u << id : 0u)
const uint DIFFUSE_KINDS = 0u MATERIALS(X);
#undef X
#define X(id, NAME, name, lobes, words) | (((lobes)&LOBE_GLOSSY) != 0u ? 1u << id : 0u)
const uint GLOSSY_KINDS = 0u MATERIALS(X);
#undef X
#define X(id, NAME, name, lobes, words) | (((lobes)&LOBE_DELTA) != 0u ? 1u << id : 0u)
const uint DELTA_KINDS = 0u MATERIALS(X);
#undef X
const uint SPECULAR_KINDS = DELTA_KINDS | GLOSSY_KINDS;
const uint GLASS_KINDS = 1u << MATERIAL_GLASS | 1u << MATERIAL_ROUGH_GLASS;
const uint SHEET_KINDS = 1u << MATERIAL_THIN_GLASS | 1u << MATERIAL_ROUGH_THIN_GLASS;
const uint DIELECTRIC_KINDS = GLASS_KINDS | SHEET_KINDS; // whose reflectance is Fresnel's
const uint LAYERED_KINDS = DIFFUSE_KINDS & SPECULAR_KINDS;

#define X(id, NAME, name, words) | 1u << id
const uint AREA_KINDS = 0u AREA_LIGHTS(X);
const uint DELTA_LIGHT_KINDS = 0u DELTA_LIGHTS(X);
const uint ENDLESS_KINDS = 0u ENDLESS_LIGHTS(X);
#undef X

SHARED_END
#endif
