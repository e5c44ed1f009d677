/// Features in words.
#include "scene/explain.h"
#include <fmt/format.h>

namespace vkpm {
namespace {

/// Why a photon map is left out; empty if it is not.
std::string mapAbsent(bool needed, bool caustic, const Features& features, const Settings& settings) {
    if (needed) return "";
    if (caustic && !features.hasMirror && !features.hasGlass) return "the scene has no specular surface";
    if ((caustic ? settings.causticPhotons : settings.photons) == 0) return "no photons were asked for";
    return "the integrator does not use it";
}

std::string fieldAbsent(const Features& features, const Settings& settings) {
    if (features.hasRadiusField) return "";
    if (!features.hasCausticMap) return "there is no caustic map";
    return settings.nearest ? "the nearest photons decide the radius" : "one caustic radius was given";
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
    has("hasTriangles", f.hasTriangles, "triangles");
    has("hasSpheres", f.hasSpheres, "spheres");
    has("hasSmoothNormals", f.hasSmoothNormals, "smooth normals");
    has("hasMirror", f.hasMirror, "mirrors");
    has("hasGlass", f.hasGlass, "glass");
    has("hasTint", f.hasTint, "tinted glass");
    has("hasExactFresnel", f.hasExactFresnel, "glass of exact reflectance");
    has("hasSchlickFresnel", f.hasSchlickFresnel, "glass of Schlick's reflectance");
    because("hasManyLights", f.hasManyLights ? "" : "the scene has one light", "the scene has several lights");
    has("hasRectangleLights", f.hasRectangleLights, "rectangles that emit");
    has("hasTriangleLights", f.hasTriangleLights, "meshes that emit");
    has("hasSphereLights", f.hasSphereLights, "spheres that emit");
    has("hasTwoSidedLights", f.hasTwoSidedLights, "lights that shine on both sides");
    because("hasGlobalMap", mapAbsent(f.hasGlobalMap, false, f, settings), "the integrator gathers from it");
    because("hasCausticMap", mapAbsent(f.hasCausticMap, true, f, settings), "the scene has specular surfaces");
    because("hasRadiusField", fieldAbsent(f, settings), "radii of caustics are measured by region");
    because("hasNearest", f.hasNearest ? "" : "it was not asked for", "it was asked for");
    return lines;
}

} // namespace vkpm
