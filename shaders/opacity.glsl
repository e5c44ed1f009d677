// Surfaces that stop a part of what meets them: the rest goes through as if nothing were there. That is decided by a
// hash of the ray and the primitive, so that it does not depend on the order in which a ray meets primitives, and
// photons, rays from the eye and shadow rays have one rule.
#ifndef OPACITY_GLSL
#define OPACITY_GLSL
#include "common.glsl"
#include "hash.h"
#include "intersect.glsl"
#include "random.glsl"
#include "texture.glsl"

// The part that is stopped at a point.
float opacityAt(DeviceScene scene, Material m, uint primitive, vec2 weights, vec3 position) {
    float opacity = 1.0 - m.seeThrough;
    uint slot = m.textures != 0u ? MaterialTexturesPtr(scene.materialTextures).at[m.textures - 1u].opacity : NONE;
    if (slot != NONE) {
        Texture t = TexturePtr(scene.textures).at[slot];
        vec2 coordinates[2] = coordinatesAt(scene, primitive, weights, position);
        opacity = t.factor.x * textureAt(scene, t, coordinates)[t.channel];
    }
    return m.cutoff > 0.0 ? float(opacity >= m.cutoff) : clamp(opacity, 0.0, 1.0);
}

// Whether a ray goes through a primitive that it meets; `again` where it meets a sphere the second time. One that
// looks for all that stops anything goes through nothing but holes.
bool letsThrough(DeviceScene scene, Ray ray, uint primitive, float t, vec2 weights, bool again, bool stopsAtAny) {
    Material m = MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[primitive].material];
    if (m.seeThrough == 0.0) return false;
    float choice = stopsAtAny ? 0.0 : choiceOfRay(ray.origin, ray.direction, 2u * primitive + uint(again));
    return choice >= opacityAt(scene, m, primitive, weights, ray.origin + t * ray.direction);
}

// The part of an area light that is there at a point of it. Rays run into that part alone; light samples and photons
// are weighted by it.
float opacityOfLight(DeviceScene scene, Light light, vec3 position) {
    uint primitive = light.primitive;
    if (light.kind == LIGHT_RECTANGLE) {
        vec2 w = weightsOf(light.u, light.v, position - light.a);
        primitive += uint(w.y > w.x);
    }
    Material m = MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[primitive].material];
    if (m.seeThrough == 0.0) return 1.0;
    return opacityAt(scene, m, primitive, weightsAt(scene, primitive, position), position);
}

#endif
