/// Textures: what they say at coordinates, and where coordinates come from; what is wrong is refused by its place.
#include "gltf_text.h"
#include "image/picture.h"
#include "images.h"
#include "judge.h"
#include "scene/identity.h"
#include "scene/textures.h"
#include "scene_on_device.h"
#include "scene_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// The small scene with a rectangle of a material.
json sceneOfMaterial(const json& material) {
    json scene = smallScene();
    scene["materials"]["textured"] = material;
    scene["shapes"][0] = {
        {"type", "rectangle"}, {"corner", {0, 0, 0}}, {"edges", {{2, 0, 0}, {0, 1, 0}}}, {"material", "textured"}};
    return scene;
}

json sceneOfTexture(const json& texture) { return sceneOfMaterial({{"type", "diffuse"}, {"albedo", texture}}); }

std::vector<vec4> valuesAt(const Scene& scene, const std::vector<vec2>& places) {
    std::vector<TextureCase> xs;
    for (const vec2& place : places) xs.push_back({0, place});
    const TestScene device(scene);
    return map<vec4>("texture_value", xs, {}, device.context());
}

/// The materials at places of a primitive.
std::vector<Material> materialsAt(const Scene& scene, uint primitive, const std::vector<vec2>& weights,
                                  const std::vector<Path>& paths = {}) {
    std::vector<SurfaceCase> xs;
    for (std::size_t i = 0; i < weights.size(); i++)
        xs.push_back({paths.empty() ? Path{} : paths[i], {1, primitive, weights[i]}});
    const TestScene device(scene);
    return map<Material>("textured_material", xs, {}, device.context());
}

// By IEC 61966-2-1, in double precision.
TEST(Textures, GreysAreWhatSrgbAndLinearSay) {
    const std::tuple<int, const char*, double> known[]{{188, "srgb", 0.50289}, {188, "linear", 0.73725},
                                                       {128, "srgb", 0.21586}, {128, "linear", 0.50196},
                                                       {255, "srgb", 1},       {0, "srgb", 0}};
    for (const auto& [grey, space, value] : known) {
        writeScene(greyPng(static_cast<unsigned char>(grey)), "grey.png");
        const Scene scene = loadJson(sceneOfTexture({{"texture", "grey.png"}, {"space", space}}));
        for (const Material& m : materialsAt(scene, 0, {{0.2f, 0.3f}, {0, 0}})) EXPECT_NEAR(m.color.y, value, 2e-5);
    }
    writeScene(pngBytes<std::uint16_t>(1, 1, {65535, 32768, 1, 65535}), "deep.png");
    const vec4 deep = valuesAt(loadJson(sceneOfTexture({{"texture", "deep.png"}})), {{0, 0}})[0];
    EXPECT_EQ(deep.x, 1);
    EXPECT_NEAR(deep.y, 32768 / 65535.0, 1e-7);
    EXPECT_NEAR(deep.z, 1 / 65535.0, 1e-9);
    writeScene(jpegBytes(16, 16, std::vector<unsigned char>(16 * 16 * 3, 188)), "grey.jpg");
    EXPECT_NEAR(valuesAt(loadJson(sceneOfTexture({{"texture", "grey.jpg"}})), {{0, 0}})[0].x, 0.5029, 0.005);
}

// Three by five texels, each of another value, far beyond the image on all sides.
TEST(Textures, WrapAndFilterAsTheHostSays) {
    std::vector<unsigned char> texels;
    Random random(1);
    for (int i = 0; i < 3 * 5 * 4; i++) texels.push_back(static_cast<unsigned char>(random.bits() % 256));
    writeScene(pngBytes(3, 5, texels), "odd.png");
    std::vector<vec2> places{{-0.25f, 0.25f}, {1.25f, -3}, {0, 0}, {1, 1}, {-1, -1}, {1e6f + 0.5f, 0.5f}};
    for (int i = 0; i < 2000; i++) places.emplace_back(random.between(-4, 4), random.between(-4, 4));
    for (const char* wrapU : {"repeat", "mirror", "clamp"})
        for (const char* wrapV : {"repeat", "mirror", "clamp"})
            for (const char* filter : {"linear", "nearest"}) {
                const Scene scene = loadJson(
                    sceneOfTexture({{"texture", "odd.png"},
                                    {"wrap", {wrapU, wrapV}},
                                    {"filter", filter},
                                    {"transform", {{"offset", {0.5, 0.25}}, {"rotation", 30}, {"scale", {2, 3}}}}}));
                const std::vector<vec4> values = valuesAt(scene, places);
                int wrong = 0; // at the edge of texels either is right
                for (std::size_t i = 0; i < places.size(); i++) {
                    if (i == 5) continue; // no digits are left of it
                    const glm::dvec4 expected =
                        textureAt(scene.textured, scene.textured.textures[0], glm::dvec2{places[i]});
                    if (glm::distance(glm::dvec4{values[i]}, expected) < 1e-4) continue;
                    ASSERT_EQ(filter, std::string{"nearest"});
                    wrong++;
                }
                EXPECT_LE(wrong, 12) << wrapU << wrapV;
            }
}

// Two by two texels at their middles and a period further; rows of images go down, coordinates up.
TEST(Textures, CheckersAreTheRightWayUp) {
    writeScene(pngBytes<unsigned char>(2, 2, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255}),
               "checker.png");
    const auto reds = [](const json& wrap) {
        const Scene scene = loadJson(sceneOfTexture({{"texture", "checker.png"}, {"space", "linear"}, {"wrap", wrap}}));
        std::vector<double> result;
        for (const vec4& value : valuesAt(scene, {{0.25f, 0.75f}, {0.75f, 0.25f}, {-0.25f, 0.75f}, {1.25f, 0.25f}}))
            result.push_back(std::round(double{value.x} * 255));
        return result;
    };
    EXPECT_THAT(reds("repeat"), ElementsAre(10, 40, 20, 30));
    EXPECT_THAT(reds("mirror"), ElementsAre(10, 40, 10, 40));
    EXPECT_THAT(reds("clamp"), ElementsAre(10, 40, 10, 40));
    // On the rectangle from its corner along the first edge, then up.
    const Scene scene =
        loadJson(sceneOfTexture({{"texture", "checker.png"}, {"space", "linear"}, {"filter", "nearest"}}));
    std::vector<double> seen;
    for (const Material& m : materialsAt(scene, 0, {{0.1f, 0.1f}, {0.8f, 0.1f}, {0.1f, 0.8f}}))
        seen.push_back(std::round(double{m.color.x} * 255)); // at (.2, .1), (.9, .1), (.9, .8)
    EXPECT_THAT(seen, ElementsAre(30, 40, 20));
}

TEST(Textures, SpheresHaveLatitudesAndLongitudes) {
    writeScene(pngBytes<unsigned char>(4, 2, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255,
                                              50, 0, 0, 255, 60, 0, 0, 255, 70, 0, 0, 255, 80, 0, 0, 255}),
               "globe.png");
    json json = sceneOfTexture({{"texture", "globe.png"}, {"space", "linear"}, {"filter", "nearest"}});
    json["shapes"][0] = {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "textured"}};
    const Scene scene = loadJson(json);
    std::vector<Path> paths;
    for (const vec3 n : {vec3{0.3f, 1, 1}, vec3{-0.3f, 1, 1}, vec3{0.9f, -1, -0.3f}, vec3{-0.9f, 1, -0.3f}})
        paths.push_back({3.0f * glm::normalize(n), -glm::normalize(n), {}, 0, NONE, 0});
    std::vector<SurfaceCase> xs;
    for (const Path& path : paths) xs.push_back({path, {2, scene.triangleCount, {0, 0}}});
    const TestScene device(scene);
    std::vector<double> seen;
    for (const Material& m : map<Material>("textured_material", xs, {}, device.context()))
        seen.push_back(std::round(double{m.color.x} * 255));
    EXPECT_THAT(seen, ElementsAre(30, 20, 80, 10)); // +z is the middle, +x to its right
}

// Numbers of textures, with their channel and factor; a lobe's width and what it leaves follow the roughness.
TEST(Textures, NumbersChooseRowsOfRoughness) {
    writeScene(pngBytes<unsigned char>(1, 1, {51, 102, 153, 204}), "four.png");
    const json texture = {{"texture", "four.png"}};
    Scene scene = loadJson(
        sceneOfMaterial({{"type", "standard"}, {"metallic", texture}, {"roughness", texture}, {"baseColor", 0.5}}));
    Material m = materialsAt(scene, 0, {{0, 0}})[0];
    EXPECT_NEAR(m.metallic, 0.6, 1e-6);
    EXPECT_NEAR(m.alpha, 0.16, 1e-6);
    EXPECT_EQ(m.rest, 2 * 12u); // 0.4 of 32 steps
    EXPECT_NEAR(m.restFraction, 0.8, 1e-5);
    for (const auto& [channel, value] : {std::pair{"r", 0.2}, {"g", 0.4}, {"b", 0.6}, {"a", 0.8}}) {
        json number = texture;
        number["channel"] = channel;
        number["factor"] = 0.5;
        scene = loadJson(sceneOfMaterial({{"type", "metal"}, {"preset", "gold"}, {"roughness", number}}));
        m = materialsAt(scene, 0, {{0, 0}})[0];
        EXPECT_NEAR(m.alpha, value * value / 4, 1e-6);
        EXPECT_EQ(m.kind, MATERIAL_METAL);
    }
    writeScene(greyPng(4), "smooth.png"); // so narrow everywhere that it is a mirror
    scene =
        loadJson(sceneOfMaterial({{"type", "metal"}, {"preset", "gold"}, {"roughness", {{"texture", "smooth.png"}}}}));
    EXPECT_EQ(scene.materials[scene.primitives[0].material].kind, MATERIAL_MIRROR);
}

// Of a texel of .2, .4, .6, .8: which of a standard material and glass is there is a choice by the ray.
TEST(Textures, StandardMaterialsTransmitAndReflectByTheirs) {
    writeScene(pngBytes<unsigned char>(1, 1, {51, 102, 153, 204}), "four.png");
    const json texture = {{"texture", "four.png"}};
    const Scene scene =
        loadJson(sceneOfMaterial({{"type", "standard"},
                                  {"baseColor", {0.1, 0.2, 0.3}},
                                  {"metallic", texture},
                                  {"roughness", 0.5},
                                  {"transmission", texture},
                                  {"specular", texture},
                                  {"specularColor", {{"texture", "four.png"}, {"space", "linear"}, {"factor", 100}}}}));
    std::vector<Path> paths;
    for (uint i = 0; i < 4000; i++)
        paths.push_back({{0, 0, 1}, glm::normalize(vec3{float(i) / 4000, 0, -1}), vec3{1}, 0, NONE, 0, 0});
    uint glass = 0;
    for (const Material& m : materialsAt(scene, 0, std::vector<vec2>(paths.size(), vec2{0.25f}), paths)) {
        glass += m.kind == MATERIAL_ROUGH_GLASS;
        EXPECT_EQ(m.color, vec3(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(m.alpha, 0.25f);
        if (m.kind != MATERIAL_STANDARD) continue;
        EXPECT_NEAR(m.transmission, 0.2 * 0.4, 1e-6);
        EXPECT_NEAR(m.metallic, 0.6 / 0.92, 1e-6);
        EXPECT_NEAR(m.grazing, 0.8, 1e-6);
        EXPECT_NEAR(m.normalIncidence.x, 0.8 * 0.04 * 100 * 0.2, 1e-6);
        EXPECT_NEAR(m.normalIncidence.z, 0.8, 1e-6); // at most all
    }
    EXPECT_NEAR(glass, 320, 4 * std::sqrt(320 * 0.92));
    const json wrong = {{"type", "standard"}, {"transmission", 0.5}};
    EXPECT_THAT(errorOf(writeScene(sceneOfMaterial(wrong).dump(), "wrong.json")),
                HasSubstr("/materials/textured/transmission: found a transmission of what is all metal"));
}

const char* const quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 0.25\nvt 0\n";

TEST(Textures, MeshesHaveCoordinates) {
    writeScene(greyPng(100), "grey.png");
    const auto load = [](const std::string& text, const std::string& name) {
        writeScene(text, name);
        json scene = sceneOfTexture({{"texture", "grey.png"}});
        scene["shapes"][0] = {{"type", "mesh"}, {"file", name}, {"material", "textured"}};
        return loadJson(scene);
    };
    Scene scene = load(quad + std::string{"f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"}, "mesh.obj");
    ASSERT_EQ(scene.textured.coordinates.size(), 4u); // the lamp is a rectangle
    EXPECT_EQ(scene.textured.coordinates[0].c, vec2(0.5f, 0.25f));
    EXPECT_EQ(scene.textured.coordinates[1].c, vec2(0, 0));
    EXPECT_TRUE(scene.warnings.empty());
    scene = load(quad + std::string{"f 1 2 3\n"}, "mesh.obj");
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr("/shapes/0: its material has a texture, but the mesh no texture")));
    scene =
        load("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
             "float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 0.1 0.2\n1 0 0 0.3 0.4\n0 1 0 0.5 0.6\n3 0 1 2\n",
             "mesh.ply");
    EXPECT_EQ(scene.textured.coordinates[0].b, vec2(0.3f, 0.4f));
    EXPECT_EQ(scene.textured.coordinates[0].c, vec2(0.5f, 0.6f));
    writeScene(quad + std::string{"vt nan 0\nf 1/1 2/5 3/3\n"}, "mesh.obj");
    json broken = sceneOfTexture({{"texture", "grey.png"}});
    broken["shapes"][0] = {{"type", "mesh"}, {"file", "mesh.obj"}, {"material", "textured"}};
    EXPECT_THAT(errorOf(broken), HasSubstr("/shapes/0: triangle 0 of the mesh, from 0, has texture coordinates"));
}

// "materials" of a mesh: faces by the names of its file, what is left by the shape's.
TEST(Textures, FacesHaveMaterialsByName) {
    writeScene(quad +
                   std::string{"f 1 2 3\nusemtl red paint\nf 1 3 4\nusemtl blue\nf 2 3 4\nusemtl red paint\nf 1 2 4\n"},
               "mesh.obj");
    json scene = smallScene();
    scene["shapes"][0] = {{"type", "mesh"},
                          {"file", "mesh.obj"},
                          {"material", "grey"},
                          {"materials", {{"red paint", "steel"}, {"blue", "water"}}}};
    const Scene loaded = loadJson(scene);
    std::vector<uint> kinds;
    for (uint i = 0; i < 4; i++) kinds.push_back(loaded.materials[loaded.primitives[i].material].kind);
    EXPECT_THAT(kinds, ElementsAre(MATERIAL_DIFFUSE, MATERIAL_MIRROR, MATERIAL_MIRROR, MATERIAL_GLASS));
    json& shape = scene["shapes"][0];
    shape["materials"] = {{"green", "steel"}};
    EXPECT_THAT(errorOf(scene),
                HasSubstr("/shapes/0/materials/green: the mesh has no faces of a material \"green\"; it "
                          "has \"red paint\" or \"blue\""));
    shape["materials"] = {{"blue", "stele"}};
    EXPECT_THAT(errorOf(scene), HasSubstr("/shapes/0/materials/blue: unknown material \"stele\"; did you mean"));
    shape.erase("material");
    shape["materials"] = {{"red paint", "steel"}, {"blue", "water"}};
    EXPECT_THAT(errorOf(scene), HasSubstr("/shapes/0: some of its faces are of no material"));
}

TEST(Textures, CountForTheIdentity) {
    const json json = sceneOfTexture({{"texture", "grey.png"}});
    writeScene(greyPng(100), "grey.png");
    const Scene one = loadJson(json);
    EXPECT_EQ(one.files.size(), 2u);
    writeScene(greyPng(101), "grey.png");
    const Scene other = loadJson(json);
    EXPECT_THAT(differences(identityOf(one, one.settings), identityOf(other, other.settings)),
                ElementsAre("scene: what the file \"grey.png\" holds"));
}

// The flux of a screen is that of its texels, whatever their number and where it is cut.
TEST(Textures, ScreensHaveTheFluxOfTheirTexels) {
    std::vector<unsigned char> texels;
    glm::dvec3 mean{0};
    for (int i = 0; i < 20 * 7; i++) {
        const int value = i == 30 ? 255 : i % 3;
        for (const int c : {value, value / 2, 0, 255}) texels.push_back(static_cast<unsigned char>(c));
        mean += glm::dvec3{value, value / 2, 0} / (255.0 * 20 * 7); // NOLINT(bugprone-integer-division)
    }
    writeScene(pngBytes(20, 7, texels), "screen.png");
    json scene = smallScene();
    scene["shapes"][1]["emission"] = {{"texture", "screen.png"}, {"space", "linear"}, {"factor", {1, 2, 3}}};
    const Scene loaded = loadJson(scene); // of 2 x 2
    EXPECT_GT(loaded.lights.size(), 1u);
    const double unit = loaded.coordinates.unit * loaded.coordinates.unit;
    for (int c = 0; c < 2; c++)
        EXPECT_NEAR(double{loaded.flux[c]} * unit, pi * 4 * (c + 1) * mean[c], 2e-3 * pi * 4 * (c + 1) * mean[c]);
    scene["shapes"][1]["emission"]["factor"] = 0;
    EXPECT_THAT(errorOf(scene), HasSubstr("there is no light"));
}

// Of models and PLY meshes, those multiply the material's own; others that share the material keep it.
TEST(Textures, ColoursOfVerticesMultiplyMaterials) {
    GltfText model = squareModel();
    auto& primitive = model.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["attributes"]["COLOR_0"] = model.add<unsigned char>(
        {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 51, 51, 51, 255}, "VEC4", {{"normalized", true}});
    model.json["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1]}}])");
    const Scene scene = loadScene(writeScene(model.glb(), "model.glb"));
    const auto near = [](float x) { return testing::FloatNear(x, 1e-6f); };
    const auto seen = materialsAt(scene, 0, {{0, 0}, {1, 0}, {0.25f, 0.25f}});
    for (const auto& [m, expected] :
         {std::pair{seen[0], vec3{1, 0, 0}}, {seen[1], {0, 0.5f, 0}}, {seen[2], {0.5f, 0.125f, 0.125f}}})
        for (int c = 0; c < 3; c++) EXPECT_THAT(m.color[c], near(expected[c]));
    EXPECT_NEAR(materialsAt(scene, 1, {{0, 1}})[0].color.x, 0.2, 1e-6); // the fourth corner

    writeScene(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 188\n1 0 0 0 255 0\n0 1 0 0 0 0\n3 0 1 2\n",
        "colours.ply");
    json painted = sceneOfMaterial({{"type", "diffuse"}, {"albedo", 0.5}});
    const json plain = painted["shapes"][0];
    painted["shapes"][0] = {{"type", "mesh"}, {"file", "colours.ply"}, {"material", "textured"}};
    painted["shapes"].push_back(plain);
    const Scene mesh = loadJson(painted);
    const vec3 corner = materialsAt(mesh, 0, {{0, 0}})[0].color;
    EXPECT_NEAR(corner.x, 0.5, 1e-6);
    EXPECT_NEAR(corner.z, 0.5 * 0.50289, 1e-5); // by the curve of sRGB
    EXPECT_EQ(mesh.materials[mesh.primitives[1].material].textures, 0u);
}

// glTF's coordinates go down; transforms, samplers, metal and roughness, opacity and emission as its specification
// says.
TEST(Textures, ModelsHaveTheirs) {
    const std::string png =
        pngBytes<unsigned char>(2, 2, {10, 51, 102, 255, 20, 0, 0, 0, 30, 0, 0, 128, 40, 0, 0, 255});
    GltfText model = squareModel();
    auto& file = model.json;
    auto& primitive = file["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["attributes"]["TEXCOORD_0"] = model.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2"); // as the picture lies
    primitive["attributes"]["TEXCOORD_1"] =
        model.add<unsigned char>({0, 0, 255, 0, 255, 255, 0, 255}, "VEC2", {{"normalized", true}});
    file["images"] = {
        {{"bufferView", model.addView(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}};
    file["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
    file["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}, {{"sampler", 0}}};
    file["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 0.5],
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}, "roughnessFactor": 0.5}, "alphaMode": "MASK"}])");
    const auto load = [&] { return loadScene(writeScene(model.glb(), "model.glb")); };
    Scene scene = load();
    // Corners of the first triangle are (0, 0), (1, 0), (1, 1) of the square.
    auto seen = materialsAt(scene, 0, {{0.1f, 0.1f}, {0.9f, 0}, {0.1f, 0.8f}});
    const auto red = [](const Material& m) { return std::round(1e5 * double{m.color.x}); };
    const auto srgb = [](int byte) {
        const double x = byte / 255.0;
        return std::round(1e5 * 0.5 * (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4)));
    };
    EXPECT_EQ(red(seen[0]), srgb(30));
    EXPECT_EQ(red(seen[1]), srgb(40));
    EXPECT_EQ(red(seen[2]), srgb(20));
    seen = materialsAt(scene, 1, {{0.1f, 0.8f}}); // (0, 0), (1, 1), (0, 1)
    EXPECT_EQ(red(seen[0]), srgb(10));
    EXPECT_NEAR(seen[0].metallic, 0.4, 1e-6);
    EXPECT_NEAR(seen[0].alpha, 0.01, 1e-6);
    EXPECT_EQ(seen[0].cutoff, 0.5f);
    EXPECT_EQ(scene.textured.textures[0].wrapU, WRAP_CLAMP);
    EXPECT_EQ(scene.textured.textures[0].wrapV, WRAP_MIRROR);
    EXPECT_EQ(scene.textured.textures[scene.textured.materials[0].opacity].channel, 3u);
    EXPECT_EQ(scene.textured.images.size(), 2u); // one of them twice, as colours and as numbers
    EXPECT_EQ(scene.textured.images[0].first, scene.textured.images[1].first);

    // A quarter turn, counter-clockwise; then a step to the right; u' = v, v' = -u.
    file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"rotation", pi / 2}, {"offset", {0, 1}}};
    scene = load();
    EXPECT_EQ(red(materialsAt(scene, 0, {{0.1f, 0.1f}})[0]), srgb(40)); // (.2, .9) -> (.9, .8)
    EXPECT_EQ(red(materialsAt(scene, 0, {{0.8f, 0.1f}})[0]), srgb(20)); // -> (.9, .1)

    file["materials"] = json::parse(R"([{"emissiveFactor": [0.5, 1, 1], "emissiveTexture": {"index": 1, "texCoord": 1},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6}}, "normalTexture": {"index": 0, "scale": 0.5}}])");
    scene = load();
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.textured.textures[0].factor, vec3(3, 6, 6));
    EXPECT_EQ(scene.textured.textures[0].set, 1u);
    EXPECT_EQ(scene.textured.sets, 2u);
    ASSERT_EQ(scene.textured.materials.size(), 1u);
    EXPECT_EQ(scene.textured.textures[scene.textured.materials[0].normal].factor, vec3(0.5f, 0.5f, 1));
    file["materials"].push_back(json::parse(R"({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 1}},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 1},
                                   "specularColorFactor": [1, 2, 3], "specularColorTexture": {"index": 1, "texCoord": 1}}}})"));
    primitive["material"] = 1;
    scene = load();
    const auto& slots = scene.textured.materials[0];
    const auto& textures = scene.textured.textures;
    EXPECT_EQ(textures[slots.transmission].factor, vec3(0.5f));
    EXPECT_EQ(textures[slots.transmission].channel, 0u);
    EXPECT_EQ(textures[slots.specular].factor, vec3(0.5f));
    EXPECT_EQ(textures[slots.specular].channel, 3u);
    EXPECT_NEAR(textures[slots.specularColor].factor.z, 0.12, 1e-6);
    EXPECT_EQ(scene.textured.images[textures[slots.specularColor].image].format, TEXELS_SRGB);
    EXPECT_EQ(scene.textured.images[textures[slots.specular].image].format, TEXELS_LINEAR);
    file["materials"][1] = json::parse(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "specularFactor": [0.5, 0.25, 1], "glossinessFactor": 0.5, "specularGlossinessTexture": {"index": 1}}}})");
    scene = load();
    const MaterialTextures& older = scene.textured.materials[0];
    EXPECT_EQ(scene.textured.textures[older.specularColor].factor, vec3(0.5f, 0.25f, 1));
    const Texture& rough = scene.textured.textures[older.roughness];
    EXPECT_EQ(rough.factor.x, 1);
    const TexelImage& image = scene.textured.images[rough.image];
    for (const auto& [x, y, gloss] : {std::tuple{0u, 0u, 0.5}, {1u, 0u, 0.0}, {0u, 1u, 0.5 * 128 / 255}})
        EXPECT_NEAR(texelOf(scene.textured, image, x, y)[int(rough.channel)], 1 - gloss, 0.51 / 255) << x << y;
    primitive["material"] = 0;

    file["materials"][0]["emissiveTexture"]["index"] = 2;
    EXPECT_THAT(load().warnings, testing::Contains(HasSubstr("neither PNG nor JPEG (KTX2, WebP) are left out")));
    file["materials"][0]["emissiveTexture"]["index"] = 3;
    EXPECT_THAT(errorOf(writeScene(model.glb(), "model.glb")), HasSubstr("/emissiveTexture/index: found 3"));
    file["materials"][0]["emissiveTexture"]["index"] = 1;
    file["images"][0] = {{"uri", "a%20picture.png"}};
    writeScene(png, "a picture.png");
    EXPECT_EQ(load().files.size(), 2u);
}

std::string claim(uint width, uint height) {
    std::string png = greyPng(1);
    for (const auto& [at, value] : {std::pair{16u, width}, {20u, height}})
        for (uint i = 0; i < 4; i++) png[at + i] = static_cast<char>(value >> (24 - 8 * i));
    uint crc = 0xffffffffu; // of the chunk's type and data
    for (std::size_t i = 12; i < 29; i++) {
        crc ^= static_cast<unsigned char>(png[i]);
        for (int k = 0; k < 8; k++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    for (uint i = 0; i < 4; i++) png[29 + i] = static_cast<char>(~crc >> (24 - 8 * i));
    return png;
}

TEST(Textures, WhatIsWrongHasItsPlace) {
    const std::string place = "scene.json: /materials/textured/albedo";
    const auto refusal = [](const json& texture) { return errorOf(sceneOfTexture(texture)); };
    const auto refusalOf = [&](const std::string& bytes) {
        writeScene(bytes, "image");
        return refusal({{"texture", "image"}});
    };
    EXPECT_THAT(refusal({{"texture", "none.png"}}), HasSubstr(place + "/texture: "));
    EXPECT_THAT(refusal({{"texture", "/dev/zero"}}),
                HasSubstr("/dev/zero: this is a device or a pipe, not a file; give a PNG"));
    EXPECT_THAT(refusalOf("not an image"), HasSubstr("found an unknown format; allowed is a PNG, JPEG"));
    EXPECT_THAT(refusalOf(greyPng(1).substr(0, 60)), HasSubstr("cannot be read as a PNG image: "));
    EXPECT_THAT(refusalOf(claim(1u << 20, 2048)),
                HasSubstr("found 1048576 x 2048 texels, 8.19e+03 MiB; allowed are 1 to "
                          "268435456, 1024 MiB"));
    EXPECT_THAT(refusalOf(claim(16384, 16384)), HasSubstr("the file ends early"));
    writeScene(greyPng(1), "image");
    for (const auto& [key, value, message] : std::initializer_list<std::tuple<const char*, json, const char*>>{
             {"space", "sRGB", "/space: "},
             {"wrap", "tile", "/wrap: "},
             {"wrap", {"repeat"}, "/wrap: "},
             {"filter", "cubic", "/filter: "},
             {"uv", 2, "/uv: found 2"},
             {"factor", -1, "/factor: found -1"},
             {"channel", "r", "/channel: found the channel of a colour"},
             {"transform", {{"ofset", {0, 0}}}, "/transform/ofset: unknown key"},
             {"colour", 1, "/colour: unknown key"}})
        EXPECT_THAT(refusal({{"texture", "image"}, {key, value}}), HasSubstr(place + message)) << key;
    EXPECT_THAT(errorOf(sceneOfMaterial({{"type", "mirror"}, {"reflectance", {{"texture", "image"}}}})),
                HasSubstr("/reflectance: "));
}

} // namespace
} // namespace vkpm
