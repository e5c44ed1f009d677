/// Features in words.
#include "render/explain.h"
#include "render/features.h"
#include "scene/lights.h"
#include "scene/materials.h"
#include "shared_kinds.h"
#include "shared_layers.h"
#include <algorithm>
#include <fmt/format.h>

namespace vkpm {
namespace {

/// Why a photon map is left out; empty if it is not.
std::string mapAbsent(bool needed, bool caustic, const Features& features, const Settings& settings) {
    if (needed) return "";
    const bool wide = caustic && features.hasWide && settings.integrator != INTEGRATOR_PHOTON_MAP;
    if (!wide && !hasMaterials(features, DIFFUSE_KINDS)) return "the scene has no diffuse surface";
    if (caustic && !features.hasNarrow) return "the scene has no specular surface";
    if ((caustic ? settings.causticPhotons : settings.photons) == 0) return "no photons were asked for";
    if (caustic && tracesLight(features, settings)) return "its photons are connected to the camera";
    const bool uses = settings.integrator == INTEGRATOR_PHOTON ||
                      (settings.integrator == INTEGRATOR_PHOTON_MAP && settings.showCaustic == caustic);
    return uses ? "nobody asked for a layer that needs it" : "the integrator does not use it";
}

/// Why a layer that was asked for has no light.
std::string layerAbsent(uint layer, const Features& features, const Settings& settings) {
    const bool specular = features.hasNarrow, receives = hasMaterials(features, DIFFUSE_KINDS) || features.hasWide;
    if (layer >= LAYER_COUNT) return "nobody asked for it";
    if (!receives && layer != LAYER_EMISSION && layer != LAYER_SPECULAR) return "the scene has no diffuse surface";
    if (!specular && (layer == LAYER_SPECULAR || layer == LAYER_CAUSTIC)) return "the scene has no specular surface";
    const bool finds =
        settings.integrator == INTEGRATOR_LIGHT ? layer == LAYER_CAUSTIC : settings.integrator != INTEGRATOR_DIRECT;
    if (finds && (layer == LAYER_CAUSTIC ? settings.causticPhotons : settings.photons) == 0)
        return "no photons were asked for";
    return "the integrator does not find it";
}

std::string fieldAbsent(const Features& features, const Settings& settings) {
    if (features.hasRadiusField) return "";
    if (!features.hasCausticMap) return "there is no caustic map";
    return settings.nearest ? "the nearest photons decide the radius" : "one caustic radius was given";
}

/// Why light samples follow no guide to a sky; empty if they do.
std::string lightGuideAbsent(const Features& features, const Settings& settings) {
    if (features.hasLightGuide) return "";
    if (!(features.lightKinds >> LIGHT_SKY & 1)) return "the scene has no light from a sky";
    if (settings.integrator != INTEGRATOR_PHOTON) return "the integrator does not use it";
    if (!settings.guides) return "guides were not asked for";
    if (!asksLights(features, settings)) return "nobody asked for a layer that needs it";
    return "most of the sky reaches what the eye sees, or it is not known yet";
}

} // namespace

std::vector<FeatureReason> explainFeatures(const Features& f, const Settings& settings) {
    std::vector<FeatureReason> lines;
    const auto has = [&](const char* name, uint needed, const char* what) {
        lines.push_back({name, needed != 0, fmt::format("the scene has {}{}", needed ? "" : "no ", what)});
    };
    const auto because = [&](const char* name, const std::string& absent, const char* present) {
        lines.push_back({name, absent.empty(), absent.empty() ? present : absent});
    };
    const auto layer = [&](const char* name, uint needed, uint index) {
        const bool asked = (settings.layers >> index & 1) != 0;
        because(name,
                needed   ? ""
                : !asked ? "nobody asked for it"
                         : layerAbsent(index, f, settings),
                "the picture shows it");
    };
    has("hasTriangles", f.hasTriangles, "triangles");
    has("hasSpheres", f.hasSpheres, "spheres");
    has("hasSmoothNormals", f.hasSmoothNormals, "smooth normals");
    has("hasContact", f.hasContact, "glass next to something opaque");
    has("hasSmoothDiffuse", f.hasSmoothDiffuse, "diffuse meshes with smooth normals");
#define X(id, NAME, name, lobes, words) has("has" #name, f.materialKinds >> id & 1, words);
    MATERIALS(X)
#undef X
    has("hasNarrow", f.hasNarrow, "surfaces that send light on in one direction, or about it");
    has("hasWide", f.hasWide, "gloss as wide as diffuse light");
    has("hasMedia", f.hasMedia, "glass that takes light away, or lies in other glass");
    has("hasDispersion", f.hasDispersion, "glass that refracts colours apart");
    has("hasTouching", f.hasTouching, "faces of glass that lie on each other");
    has("hasTextures", f.hasTextures, "textures");
    has("hasNormalMaps", f.hasNormalMaps, "normal maps");
    has("hasMixed", f.hasMixed, "surfaces that transmit a part");
    has("hasOpacity", f.hasOpacity, "surfaces that are not opaque");
    has("hasEmissionTextures", f.hasEmissionTextures, "emission by a texture");
    has("hasTint", f.hasTint, "tinted glass");
    has("hasExactFresnel", f.hasExactFresnel, "glass of exact reflectance");
    has("hasSchlickFresnel", f.hasSchlickFresnel, "glass of Schlick's reflectance");
    because("hasManyLights", f.hasManyLights ? "" : "the scene has one light", "the scene has several lights");
#define X(id, NAME, name, words) has("has" #name "Lights", f.lightKinds >> id & 1, words);
    LIGHTS(X)
#undef X
    has("hasTwoSidedLights", f.hasTwoSidedLights, "lights that shine on both sides");
    because("hasLens", f.hasLens ? "" : "the camera is a pinhole", "the camera has a lens");
    because("hasFarLights", f.hasFarLights ? "" : "all lights are near what they light",
            "photons of a light far away are aimed at the scene");
    because("hasGuide",
            f.hasGuide                          ? ""
            : f.hasGlobalMap || f.hasCausticMap ? "most photons are useful, or none, or it is not known yet"
                                                : "there is no photon map",
            "photons are sent where the eye looks");
    because("hasLightGuide", lightGuideAbsent(f, settings), "light samples go where the sky comes in, by region");
    because("hasGlobalMap", mapAbsent(f.hasGlobalMap, false, f, settings), "the integrator gathers from it");
    because("hasCausticMap", mapAbsent(f.hasCausticMap, true, f, settings), "the scene has specular surfaces");
    because("hasRadiusField", fieldAbsent(f, settings), "radii of caustics are measured by region");
    because("hasNearest", f.hasNearest ? "" : "it was not asked for", "it was asked for");
    layer("hasEmissionLayer", f.hasEmissionLayer, LAYER_EMISSION);
    layer("hasDirectLayer", f.hasDirectLayer, LAYER_DIRECT);
    layer("hasSpecularLayer", f.hasSpecularLayer, LAYER_SPECULAR);
    layer("hasCausticLayer", f.hasCausticLayer, LAYER_CAUSTIC);
    layer("hasIndirectLayer", f.hasIndirectLayer, LAYER_INDIRECT);
    layer("hasAlbedo", f.hasAlbedo, ASK_ALBEDO);
    layer("hasNormal", f.hasNormal, ASK_NORMAL);
    layer("hasDepth", f.hasDepth, ASK_DEPTH);
    layer("hasNoise", f.hasNoise, ASK_NOISE);
    because("hasBias",
            f.hasBias                            ? ""
            : !(settings.layers >> ASK_BIAS & 1) ? "nobody asked for it"
                                                 : "nothing is read from a photon map",
            "photon maps blur");
    because("hasLabels", f.hasLabels ? "" : "nobody asked for them", "--labels asks for them");
    because("checksFeatures", f.checksFeatures ? "" : "only debug builds do it", "this is a debug build");
    return lines;
}

std::string blindness(const Scene& scene, const Settings& settings) {
    const auto any = [&](auto&& is) {
        return std::ranges::any_of(scene.primitives,
                                   [&](const Primitive& p) { return is(scene.materials[p.material]); });
    };
    if (settings.integrator == INTEGRATOR_PATH && std::ranges::any_of(scene.lights, isDelta) && any(isNarrow))
        return "the path tracer cannot find caustics of lights without a size: points and spots of radius 0; the "
               "photon integrator does";
    if (settings.integrator == INTEGRATOR_LIGHT && any(isNarrow) &&
        any([](const Material& m) { return m.wide == WIDE_BY_RAYS; }))
        return "light tracing does not see caustics that fall on all glass of roughness 0.5 and more; the photon "
               "integrator does";
    return "";
}

} // namespace vkpm
