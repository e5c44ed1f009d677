/// Materials of a scene file.
#include "scene/materials.h"
#include "scene/glass_material.h"
#include "scene/rest.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <tbb/parallel_for.h>

namespace vkpm {
namespace {

/// Rows of the roughnesses of a texture, by those of one alpha.
template <class Rows> std::vector<float> rowsOfTexture(Rows rowsOf) {
    std::vector<std::vector<float>> all(ROUGHNESS_STEPS + 1);
    tbb::parallel_for(0u, ROUGHNESS_STEPS + 1, [&](uint i) {
        const double r = double(i) / ROUGHNESS_STEPS;
        all[i] = rowsOf(std::max(r * r, double{LEAST_ALPHA}));
    });
    std::vector<float> rows;
    for (const std::vector<float>& some : all) rows.insert(rows.end(), some.begin(), some.end());
    return rows;
}

/// Gives a lobe its width and what it leaves to a diffuse one, `rowsOf` its alpha, where roughness may be a texture.
template <class Rows>
void setRoughness(Material& material, float roughness, bool textured, Textures& textures, Rows rowsOf) {
    material.alpha = std::max(LEAST_ALPHA, roughness * roughness);
    material.rest = placeRows(textures.scene.rests, textured ? rowsOfTexture(rowsOf) : rowsOf(double{material.alpha}));
}

Material readDiffuse(Reader& reader, Textures& textures, MaterialTextures& slots) {
    Material material{MATERIAL_DIFFUSE, textures.color(reader.at("albedo"), fraction, slots.color), 1};
    return material;
}

Material readMirror(Reader& reader, Textures&, MaterialTextures&) {
    return {MATERIAL_MIRROR, reader.at("reflectance").color(fraction), 1};
}

float numberOr(Reader& reader, std::string_view key, float otherwise, Range range) {
    const auto number = reader.find(key);
    return number ? number->number(range) : otherwise;
}

/// A roughness, or the greatest of its texture.
float readRoughness(Reader& reader, float otherwise, Textures& textures, uint& slot, uint channel = 0) {
    const auto roughness = reader.find("roughness");
    return roughness ? textures.number(*roughness, fraction, slot, channel) : otherwise;
}

Material readGlass(Reader& reader, Textures& textures, MaterialTextures& slots) {
    const Reader iorReader = reader.at("ior");
    const float ior = iorReader.number(positive), exterior = numberOr(reader, "exteriorIor", 1, positive);
    if (const float ratio = ior / exterior; !(ratio >= 1e-3f && ratio <= 1e3f))
        iorReader.fail(fmt::format("found {} times the index outside", ratio), "allowed is a ratio from 0.001 to 1000");
    const auto tint = reader.find("tint");
    return readGlass(reader, textures.scene, tint ? tint->color(fraction) : vec3{1}, ior, exterior,
                     readRoughness(reader, 0, textures, slots.roughness));
}

struct Metal {
    std::string_view name;
    vec3 reflectance; // at normal incidence, linear Rec. 709
};
/// Hoffman, Physics and math of shading, SIGGRAPH 2012.
const std::vector<Metal> metals{{"gold", {1.000f, 0.766f, 0.336f}},   {"silver", {0.972f, 0.960f, 0.915f}},
                                {"copper", {0.955f, 0.637f, 0.538f}}, {"aluminium", {0.913f, 0.921f, 0.925f}},
                                {"iron", {0.560f, 0.570f, 0.580f}},   {"chromium", {0.549f, 0.556f, 0.554f}}};

vec3 readReflectance(Reader& reader, Textures& textures, uint& slot) {
    const auto preset = reader.find("preset");
    const auto reflectance = reader.find("reflectance");
    if (preset && reflectance) preset->fail("found both \"preset\" and \"reflectance\"", "give one of them");
    if (!preset) return textures.color(reflectance ? *reflectance : reader.at("reflectance"), fraction, slot);
    std::vector<std::string_view> names;
    for (const Metal& metal : metals) names.push_back(metal.name);
    return metals[preset->choice(names)].reflectance;
}

Material readMetal(Reader& reader, Textures& textures, MaterialTextures& slots) {
    const vec3 reflectance = readReflectance(reader, textures, slots.color);
    const float roughness = readRoughness(reader, 0, textures, slots.roughness);
    const auto multiscatter = reader.find("multiscatter");
    const bool scattersMore = !multiscatter || multiscatter->boolean();
    if (roughness * roughness < LEAST_ALPHA) {
        slots.roughness = NONE;
        return {MATERIAL_MIRROR, reflectance, 1};
    }
    Material material{MATERIAL_METAL, reflectance, 1};
    setRoughness(material, roughness, slots.roughness != NONE, textures,
                 [](double alpha) { return restRow(alpha, 1); });
    if (!scattersMore) material.rest = NONE;
    return material;
}

Material readPlastic(Reader& reader, Textures& textures, MaterialTextures& slots) {
    const vec3 albedo = textures.color(reader.at("albedo"), fraction, slots.color);
    const auto ior = reader.find("ior");
    const float index = ior ? ior->number({1, 1000}) : 1.5f,
                roughness = readRoughness(reader, 0.3f, textures, slots.roughness);
    const double r = (double{index} - 1) / (double{index} + 1);
    Material material{MATERIAL_PLASTIC, albedo, index};
    setRoughness(material, roughness, slots.roughness != NONE, textures,
                 [r](double alpha) { return restRow(alpha, r * r); });
    return material;
}

/// Reflectances of a coat at normal incidence and at grazing incidence, by its index and KHR_materials_specular, whose
/// number is in the alpha of a texture. Where one of them is a texture, kernels multiply them.
void readCoat(Reader& reader, Textures& textures, MaterialTextures& slots, Material& material) {
    const auto specular = reader.find("specular"), color = reader.find("specularColor");
    material.grazing = specular ? textures.number(*specular, fraction, slots.specular, 3) : 1;
    const float r = (material.ior - 1) / (material.ior + 1);
    material.normalIncidence = r * r * (color ? textures.color(*color, notNegative, slots.specularColor) : vec3{1});
    if (slots.specularColor != NONE)
        textures.scene.textured.textures[slots.specularColor].factor = material.normalIncidence;
    if ((slots.specular & slots.specularColor) == NONE)
        material.normalIncidence = glm::min(material.normalIncidence, vec3{1}) * material.grazing;
}

/// glTF's metallic-roughness model with its defaults, with KHR_materials_ior, _specular and _transmission. As in glTF,
/// metal is in the blue of a texture, roughness in the green. What transmits a part becomes glass with what stands
/// beside it, which goes into the scene.
Material readStandard(Reader& reader, Textures& textures, MaterialTextures& slots) {
    const auto color = reader.find("baseColor"), transmissionReader = reader.find("transmission"),
               metallicReader = reader.find("metallic");
    Material material{MATERIAL_STANDARD, color ? textures.color(*color, fraction, slots.color) : vec3{1}};
    material.metallic = metallicReader ? textures.number(*metallicReader, fraction, slots.metallic, 2) : 1;
    const float roughness = readRoughness(reader, 1, textures, slots.roughness, 1);
    material.ior = numberOr(reader, "ior", 1.5f, {0, 1000});
    readCoat(reader, textures, slots, material);
    material.transmission = transmissionReader ? textures.number(*transmissionReader, fraction, slots.transmission) : 0;

    const bool transmits = material.transmission > 0, isMetal = material.metallic == 1 && slots.metallic == NONE,
               isWhole =
                   transmits && material.transmission == 1 && slots.transmission == NONE && material.metallic == 0;
    if (transmits && isMetal)
        transmissionReader->fail("found a transmission of what is all metal",
                                 "allowed where \"metallic\" is below 1, as 0 is; it is 1 if it is absent");
    if (!isWhole && material.grazing == 0 && material.metallic == 0 && !transmits)
        return {MATERIAL_DIFFUSE, material.color, 1};
    if (!isWhole) setRoughness(material, roughness, slots.roughness != NONE, textures, standardRows);
    if (!transmits) return material;
    Material glass = readGlass(reader, textures.scene, material.color, std::max(material.ior, 1e-3f), 1, roughness);
    if (!isWhole) {
        textures.scene.materials.push_back(material);
        glass.base = static_cast<uint>(textures.scene.materials.size());
    }
    return glass;
}

/// The part of what meets a surface that it stops. What nothing goes through is opaque.
void readOpacity(Reader& reader, Material& material, Textures& textures, MaterialTextures& slots) {
    const auto opacity = reader.find("opacity"), cutoff = reader.find("cutoff");
    if (cutoff && !opacity) cutoff->fail("found a \"cutoff\" without \"opacity\"", "give both, or none");
    if (!opacity) return;
    const float greatest = textures.number(*opacity, fraction, slots.opacity);
    if (cutoff) material.cutoff = cutoff->number(fraction);
    const bool always = cutoff && material.cutoff == 0;
    if (always) slots.opacity = NONE;
    material.seeThrough = always ? 0 : slots.opacity != NONE ? 1 : 1 - greatest;
}

struct MaterialType {
    std::string_view name;
    Material (*read)(Reader&, Textures& textures, MaterialTextures& slots);
};

/// What "type" may be.
const std::vector<MaterialType> materialTypes{{"diffuse", readDiffuse}, {"mirror", readMirror},
                                              {"glass", readGlass},     {"metal", readMetal},
                                              {"plastic", readPlastic}, {"standard", readStandard}};

} // namespace

Material readMaterial(Reader reader, Textures& textures) {
    std::vector<std::string_view> names;
    for (const MaterialType& type : materialTypes) names.push_back(type.name);
    MaterialTextures slots = noTextures;
    const MaterialType& type = materialTypes[reader.at("type").choice(names)];
    Material material = type.read(reader, textures, slots);
    const auto normalMap = type.read != readMirror ? reader.find("normalMap") : std::nullopt;
    if (normalMap) slots.normal = textures.normals(*normalMap);
    material.wide = material.alpha >= textures.scene.wideAlpha ? WIDE_BY_RAYS : 0;
    readOpacity(reader, material, textures, slots);
    material.textures = textures.place(slots);
    reader.finish();
    if (material.base != 0) {
        Material& base = textures.scene.materials[material.base - 1];
        base.wide = material.wide;
        base.textures = material.textures;
        base.seeThrough = material.seeThrough;
        base.cutoff = material.cutoff;
    }
    return material;
}

void chooseWide(Scene& scene) {
    for (Material& material : scene.materials) {
        if (material.wide == 0) continue;
        const bool glass = (DIELECTRIC_KINDS >> material.kind & 1) != 0;
        const bool mapped = material.textures != 0 && scene.textured.materials[material.textures - 1].normal != NONE;
        const bool spreads = material.alpha * std::abs(1 - 1 / material.ior) >= 0.05f; // what it refracts, too
        const bool plain = material.kind == MATERIAL_ROUGH_GLASS && material.base == 0 && !mapped && spreads;
        material.wide = !glass || (plain && scene.media.empty()) ? WIDE_BY_PHOTONS : WIDE_BY_RAYS;
    }
}

} // namespace vkpm
