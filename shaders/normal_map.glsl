// Normal maps: surfaces that stand for rough ones whose facets are turned. The mapped normal is `shading` of a surface.
//
// Of its diffuse lobe, light counts by the mapped normal; light from below the surface is mirrored at it, see
// terminator.glsl, so that none is lost. Other lobes scatter about the mapped normal. To turn them alone gains light or
// loses it (Veach 1997, section 5.3), and products of the weights of photons grow without bound. So an event is kept
// with a probability, which makes the function of scattering the same both ways and its whole one, and light of events
// that are not kept returns the way it came, as from two facets of a groove. Where Schuessler et al. (2017) let it go
// on to a facet beside, what it first meets is about the same.
#ifndef NORMAL_MAP_GLSL
#define NORMAL_MAP_GLSL
#include "common.glsl"
#include "shared_scene.h"
#include "surface.glsl"
#include "texture.glsl"

const float LEAST_TILT_COSINE = 0.01; // of a mapped normal to the surface: those below it are turned up to there

// The directions in which the coordinates of a texture grow at a point of a surface, not of unit length; 0 where they
// do not.
void textureAxes(DeviceScene scene, Surface s, uint set, out vec3 u, out vec3 v) {
    if (s.primitive >= scene.triangleCount) {
        u = vec3(s.normal.z, 0.0, -s.normal.x);
        v = cross(s.normal, u);
        return;
    }
    Primitive p = PrimitivePtr(scene.primitives).at[s.primitive];
    TexturePlaces c = TexturePlacesPtr(scene.coordinates).at[set * scene.triangleCount + s.primitive];
    vec3 ab = p.b - p.a, ac = p.c - p.a;
    float scale = unitScale(ab, ac);
    vec2 b = c.b - c.a, d = c.c - c.a;
    float side = sign(b.x * d.y - b.y * d.x);
    u = side * scale * (d.y * ab - b.y * ac);
    v = side * scale * (b.x * ac - d.x * ab);
}

// The same as the mesh has them, if it does.
bool hasOwnAxes(DeviceScene scene, Surface s, vec2 weights, out vec3 u, out vec3 v) {
    u = v = vec3(0.0);
    if (scene.tangents == uvec2(0u) || s.primitive >= scene.triangleCount) return false;
    Tangents t = TangentsPtr(scene.tangents).at[s.primitive];
    u = t.a + weights.x * (t.b - t.a) + weights.y * (t.c - t.a);
    v = t.side * cross(s.shading, u);
    return dot(v, v) > 1e-12;
}

// Turns the shading normal of a surface as its material says. Axes are those of the mesh or of the triangle; along a
// smooth mesh they are kept across its shading normal (as in Pharr, Jakob & Humphreys 2016, section 9.1).
void mapNormal(DeviceScene scene, inout Surface s, Material m, vec2 weights) {
    if (!hasNormalMaps || m.textures == 0u) return;
    uint index = MaterialTexturesPtr(scene.materialTextures).at[m.textures - 1u].normal;
    if (index == NONE) return;
    Texture t = TexturePtr(scene.textures).at[index];
    vec3 u, v;
    if (!hasOwnAxes(scene, s, weights, u, v) && (s.primitive >= scene.triangleCount || t.set < scene.coordinateSets))
        textureAxes(scene, s, t.set, u, v);
    u -= dot(u, s.shading) * s.shading;
    float length2 = dot(u, u);
    if (!(length2 > 1e-30)) return;
    u *= inversesqrt(length2);
    vec3 across = cross(s.shading, u);
    if (dot(across, v) < 0.0) across = -across;
    vec3 value =
        t.factor * (2.0 * textureAt(scene, t, coordinatesAt(scene, s.primitive, weights, s.position)).rgb - 1.0);
    vec3 mapped = value.x * u + value.y * across + value.z * s.shading;
    float size2 = dot(mapped, mapped);
    if (!(size2 > 1e-30)) return;
    mapped *= inversesqrt(size2);
    float up = dot(mapped, s.normal);
    if (up < LEAST_TILT_COSINE) mapped = normalize(mapped + (LEAST_TILT_COSINE - up) * s.normal);
    s.shading = mapped;
    s.mapped = true;
    s.bulge = 0.0;
}

bool isMapped(Surface s) { return hasNormalMaps && s.mapped; }

// How a surface bulges, see terminator.glsl, on the side of its normal or behind it: light below a mapped surface is
// mirrored on both sides.
float bulgeOn(Surface s, bool behind) { return isMapped(s) ? -1.0 : behind ? -s.bulge : s.bulge; }

// Probability with which an event about a mapped normal that turns the direction d into w is kept, as in a walk of
// Metropolis et al. (1953) whose equilibrium is light from everywhere.
float mappedAcceptance(Surface s, vec3 d, vec3 w) {
    return min(1.0, abs(dot(w, s.normal) * dot(d, s.shading)) / max(abs(dot(w, s.shading) * dot(d, s.normal)), 1e-30));
}

#endif
