/// What a scene and its settings need of the kernels.
#include "render/features.h"
#include "scene/glass.h"
#include "scene/lights.h"
#include "scene/materials.h"
#include "shared_layers.h"
#include "shared_scene.h"
#include <algorithm>

namespace vkpm {

void askFor(uint layers, Features& features) {
    features.hasEmissionLayer &= layers >> LAYER_EMISSION;
    features.hasDirectLayer &= layers >> LAYER_DIRECT;
    features.hasSpecularLayer &= layers >> LAYER_SPECULAR;
    features.hasCausticLayer &= layers >> LAYER_CAUSTIC;
    features.hasIndirectLayer &= layers >> LAYER_INDIRECT;
    features.hasAlbedo &= layers >> ASK_ALBEDO;
    features.hasNormal &= layers >> ASK_NORMAL;
    features.hasDepth &= layers >> ASK_DEPTH;
    features.hasNoise &= layers >> ASK_NOISE;
    features.hasBias &= layers >> ASK_BIAS;
}

bool asksLights(const Features& f, const Settings& settings) {
    const bool finds = settings.integrator == INTEGRATOR_PATH ||
                       (settings.integrator == INTEGRATOR_PHOTON && f.hasWide); // caustics by paths
    const bool byGloss = finds && hasMaterials(f, GLOSSY_KINDS) && f.hasCausticLayer;
    return settings.integrator != INTEGRATOR_PHOTON_MAP && hasMaterials(f, DIFFUSE_KINDS | GLOSSY_KINDS) &&
           (f.hasDirectLayer || f.hasSpecularLayer || f.hasIndirectLayer || byGloss);
}

bool tracesLight(const Features& f, const Settings& settings) {
    return settings.integrator == INTEGRATOR_LIGHT && f.hasCausticLayer;
}

bool asksMaps(const Features& f) { return f.hasGlobalMap || f.hasCausticMap; }

/// Leaves out the layers that cannot have any light and the maps that no layer needs, by what the settings ask for and
/// by materials that the features know: for the general program, all.
static void chooseLayers(Features& f, const Settings& settings) {
    const bool photon = settings.integrator == INTEGRATOR_PHOTON;
    const bool path = settings.integrator == INTEGRATOR_PATH;
    const bool map = settings.integrator == INTEGRATOR_PHOTON_MAP;
    const bool light = settings.integrator == INTEGRATOR_LIGHT;
    const bool diffuse = hasMaterials(f, DIFFUSE_KINDS), narrow = f.hasNarrow, wide = f.hasWide && !map;
    const bool receives = diffuse || wide;
    const bool global = (photon || (map && !settings.showCaustic)) && settings.photons > 0 && diffuse;
    const bool caustic =
        (photon || light || (map && settings.showCaustic)) && settings.causticPhotons > 0 && receives && narrow;
    askFor(settings.layers, f);
    f.hasEmissionLayer &= !map && !light;
    f.hasDirectLayer &= !map && !light && receives;
    f.hasSpecularLayer &= !light && (narrow || (map && f.hasWide));
    f.hasCausticLayer &= caustic || ((path || (photon && wide && settings.causticPhotons > 0)) && receives && narrow);
    f.hasIndirectLayer &= global || (path && receives) || (photon && wide && settings.photons > 0);
    f.hasGlobalMap = global && (f.hasIndirectLayer || f.hasSpecularLayer);
    f.hasCausticMap = caustic && !light && (f.hasCausticLayer || f.hasSpecularLayer || f.hasIndirectLayer);
    f.hasBias &= asksMaps(f) && !settings.showPoints;
}

Features sceneFeatures(const Scene& scene, const Settings& settings) {
    Features features;
#ifndef NDEBUG
    features.checksFeatures = 1;
#endif
    features.hasLabels = settings.labels;
    if (settings.allFeatures) {
        features.stackSize = std::max(features.stackSize, scene.stackSize);
        chooseLayers(features, settings);
        return features;
    }
    const auto anyMaterial = [&](auto&& is) {
        return std::ranges::any_of(scene.primitives, [&](const Primitive& p) {
            const Material& m = scene.materials[p.material];
            return is(m) || (m.base != 0 && is(scene.materials[m.base - 1]));
        });
    };
    const auto anyLight = [&](auto&& is) { return std::ranges::any_of(scene.lights, is); };
    features.hasTriangles = scene.triangleCount > 0;
    features.hasSpheres = scene.primitives.size() > scene.triangleCount;
    features.hasSmoothNormals = !scene.normals.empty();
    features.hasSmoothDiffuse = std::ranges::any_of(scene.primitives, [&](const Primitive& p) {
        return p.normals != NONE && scene.materials[p.material].kind == MATERIAL_DIFFUSE;
    });
    features.materialKinds = features.lightKinds = 0;
    (void)anyMaterial([&](const Material& m) {
        features.materialKinds |= 1u << m.kind;
        return false;
    });
    for (const Light& light : scene.lights) {
        features.lightKinds |= 1u << light.kind;
        if (light.kind == LIGHT_SPHERE && light.v != vec3{0}) features.lightKinds |= 1u << LIGHT_SPOT; // has its beam
    }
    const bool glass = hasMaterials(features, DIELECTRIC_KINDS);
    features.hasContact = hasMaterials(features, GLASS_KINDS) && glassMayTouchOpaque(scene);
    features.hasNarrow = anyMaterial(isNarrow);
    features.hasWide = anyMaterial([](const Material& m) { return m.wide != 0; });
    features.hasMedia = !scene.media.empty();
    features.hasDispersion =
        std::ranges::any_of(scene.media, [](const Medium& medium) { return medium.spread != vec2{0}; });
    features.hasTouching = !scene.touching.empty();
    features.hasTint = anyMaterial([](const Material& m) {
        return (DIELECTRIC_KINDS >> m.kind & 1) != 0 && (m.color != vec3(1) || m.textures != 0);
    });
    features.hasExactFresnel = glass && !settings.schlick;
    features.hasSchlickFresnel = glass && settings.schlick;
    features.hasTextures = anyMaterial([](const Material& m) { return m.textures != 0; });
    features.hasNormalMaps = anyMaterial(
        [&](const Material& m) { return m.textures != 0 && scene.textured.materials[m.textures - 1].normal != NONE; });
    features.hasSmoothNormals |= features.hasNormalMaps;
    features.hasSmoothDiffuse |= features.hasNormalMaps;
    features.hasMixed = anyMaterial([](const Material& m) { return m.base != 0; });
    features.hasOpacity = anyMaterial([](const Material& m) { return m.seeThrough > 0; });
    features.hasEmissionTextures = anyLight([](const Light& light) { return light.texture != 0; });
    features.hasManyLights = scene.lights.size() > 1;
    features.hasTwoSidedLights = anyLight([](const Light& light) { return light.twoSided != 0; });
    features.hasLens = scene.view.lens.aperture > 0;
    features.hasGuide = 0; // the renderer finds out
    uint farLights = 0;
    for (const Light& light : scene.lights)
        if (isFar(scene, light))
            farLights += light.kind == LIGHT_SPHERE && light.twoSided != 0 ? 2 : 1; // its inside is behind its outside
    features.hasFarLights = std::min(farLights, 2u);
    chooseLayers(features, settings);
    features.hasLightGuide = (features.lightKinds >> LIGHT_SKY & 1) != 0 && settings.guides &&
                             settings.integrator == INTEGRATOR_PHOTON && asksLights(features, settings);
    features.hasNearest = settings.nearest > 0;
    features.hasRadiusField = features.hasCausticMap && !settings.causticRadius && settings.nearest == 0;
    features.densityKernel = settings.kernel;
    features.integrator = settings.integrator;
    features.stackSize = scene.stackSize;
    return features;
}

} // namespace vkpm
