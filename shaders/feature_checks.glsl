// Checks that nothing was left out that the scene needs. They cost time, so that debug builds alone make them.
#ifndef FEATURE_CHECKS_GLSL
#define FEATURE_CHECKS_GLSL
#include "common.glsl"
#include "shared_scene.h"

void require(DeviceScene scene, bool needed, bool has, uint id) {
    if (needed && !has) atomicOr(uintPtr(scene.missing).at[id / 32u], 1u << (id % 32u));
}

void requireLight(DeviceScene scene, Light light) {
    if (!checksFeatures) return;
    require(scene, scene.lightCount > 1u, hasManyLights, id_hasManyLights);
    require(scene, true, (lightKinds >> light.kind & 1u) != 0u, id_lightKinds);
    require(scene, light.texture != 0u, hasEmissionTextures, id_hasEmissionTextures);
    require(scene, light.twoSided != 0u, hasTwoSidedLights, id_hasTwoSidedLights);
}

void requireSurface(DeviceScene scene, uint primitive, Material material) {
    if (!checksFeatures) return;
    bool triangle = primitive < scene.triangleCount;
    bool glass = (DIELECTRIC_KINDS >> material.kind & 1u) != 0u;
    require(scene, triangle, hasTriangles, id_hasTriangles);
    require(scene, !triangle, hasSpheres, id_hasSpheres);
    require(scene, triangle && PrimitivePtr(scene.primitives).at[primitive].normals != NONE, hasSmoothNormals,
            id_hasSmoothNormals);
    require(scene, true, (materialKinds >> material.kind & 1u) != 0u, id_materialKinds);
    require(scene,
            triangle && PrimitivePtr(scene.primitives).at[primitive].normals != NONE &&
                material.kind == MATERIAL_DIFFUSE,
            hasSmoothDiffuse, id_hasSmoothDiffuse);
    require(scene, scene.media != uvec2(0u), hasMedia, id_hasMedia);
    require(scene, scene.touching != uvec2(0u), hasTouching, id_hasTouching);
    require(scene, scene.media != uvec2(0u) && material.spread != vec2(0.0), hasDispersion, id_hasDispersion);
    require(scene, material.textures != 0u, hasTextures, id_hasTextures);
    require(scene, material.seeThrough > 0.0, hasOpacity, id_hasOpacity);
    require(scene,
            material.textures != 0u &&
                MaterialTexturesPtr(scene.materialTextures).at[material.textures - 1u].normal != NONE,
            hasNormalMaps && hasSmoothNormals && hasSmoothDiffuse, id_hasNormalMaps);
    require(scene, material.wide != 0u, hasWide, id_hasWide);
    require(scene, material.base != 0u, hasMixed, id_hasMixed);
    require(scene, material.wide == 0u && material.kind != MATERIAL_DIFFUSE, hasNarrow, id_hasNarrow);
    require(scene, glass && material.color != vec3(1.0), hasTint, id_hasTint);
    require(scene, glass && material.schlick != 0u, hasSchlickFresnel, id_hasSchlickFresnel);
    require(scene, glass && material.schlick == 0u, hasExactFresnel, id_hasExactFresnel);
}

#endif
