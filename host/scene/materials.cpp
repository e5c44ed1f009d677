/// Materials of a scene file.
#include "scene/materials.h"
#include <fmt/format.h>

namespace vkpm {
namespace {

/// Index inside over index outside.
float readIor(Reader& glass) {
    const Reader iorReader = glass.at("ior");
    const float inside = iorReader.number(positive);
    const auto exterior = glass.find("exteriorIor");
    const float ratio = inside / (exterior ? exterior->number(positive) : 1.0f);
    if (!(ratio >= 1e-3f && ratio <= 1e3f))
        iorReader.fail(fmt::format("found {} times the index outside", ratio), "allowed is a ratio from 0.001 to 1000");
    return ratio;
}

Material readDiffuse(Reader& reader) { return {MATERIAL_DIFFUSE, reader.at("albedo").color(fraction), 1}; }

Material readMirror(Reader& reader) { return {MATERIAL_MIRROR, reader.at("reflectance").color(fraction), 1}; }

Material readGlass(Reader& reader) {
    Material material{MATERIAL_GLASS, vec3{1}, readIor(reader)};
    if (const auto tint = reader.find("tint")) material.color = tint->color(fraction);
    return material;
}

struct MaterialType {
    std::string_view name;
    Material (*read)(Reader&);
};
/// What "type" may be.
const std::vector<MaterialType> materialTypes{{"diffuse", readDiffuse}, {"mirror", readMirror}, {"glass", readGlass}};

} // namespace

Material readMaterial(Reader reader) {
    std::vector<std::string_view> names;
    for (const MaterialType& type : materialTypes) names.push_back(type.name);
    const Material material = materialTypes[reader.at("type").choice(names)].read(reader);
    reader.finish();
    return material;
}

} // namespace vkpm
