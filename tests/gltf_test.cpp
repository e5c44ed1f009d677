/// glTF files: geometry, cameras, lamps and materials as the specification has them; what is wrong has its place.
#include "packed_models.h"
#include "scene/identity.h"
#include "scene/mikktspace.h"
#include "scene_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <numbers>

namespace vkpm {
namespace {

using glm::dvec3;
using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;

Scene loadModel(const GltfText& model) { return loadScene(writeScene(model.glb(), "model.glb")); }

/// A scene that imports the model, with a lamp and a camera of its own.
json importing(const json& import) {
    json scene = smallScene();
    scene["import"] = import;
    scene["shapes"].erase(0);
    return scene;
}

std::vector<dvec3> placesOf(const Scene& scene) {
    std::vector<dvec3> places;
    for (uint i = 0; i < scene.triangleCount; i++)
        for (const vec3& point : {scene.primitives[i].a, scene.primitives[i].b, scene.primitives[i].c})
            places.push_back(scene.coordinates.world(point));
    return places;
}

double areaOf(const Scene& scene) {
    double sum = 0;
    for (uint i = 0; i < scene.triangleCount; i++) {
        const Primitive& p = scene.primitives[i];
        sum += glm::length(glm::cross(dvec3{p.b - p.a}, dvec3{p.c - p.a})) / 2;
    }
    return sum;
}

vec3 normalOf(const Primitive& p) { return glm::normalize(glm::cross(p.b - p.a, p.c - p.a)); }

TEST(Gltf, AModelIsAScene) {
    const Scene scene = loadModel(fullModel());
    EXPECT_EQ(scene.triangleCount, 2u + 2 + 1 + 2 * 2); // square, strip, fan, two instances of the square
    EXPECT_EQ(scene.view.fieldOfView, 0.7f);
    EXPECT_EQ(scene.settings.size, uvec2(512, 256));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("/extensionsUsed: unknown extensions are left out: \"EXT_none\"")));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("/meshes/1/primitives/2: points and lines are left out")));
    EXPECT_EQ(scene.lights.at(0).kind, LIGHT_SUN);
    // The camera is at (0, 1, 6) of a node that is scaled by -2 along z: it looks towards +z.
    EXPECT_NEAR(glm::distance(scene.coordinates.world(scene.view.origin), dvec3(0, 2, -12)), 0, 1e-5);
    EXPECT_NEAR(glm::normalize(scene.view.target - scene.view.origin).z, 1, 1e-6);
}

TEST(Gltf, StripsFansAndPlainTrianglesAreTheSameSquare) {
    const std::vector<float> round{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, zigzag{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    for (const int mode : {4, 5, 6}) {
        GltfText model = squareModel();
        json& primitive = model.json["meshes"][0]["primitives"][0];
        primitive["attributes"]["POSITION"] = model.add<float>(mode == 5 ? zigzag : round, "VEC3");
        primitive["mode"] = mode;
        if (mode != 4) primitive.erase("indices");
        const Scene scene = loadModel(model);
        EXPECT_EQ(scene.triangleCount, 2u);
        EXPECT_NEAR(areaOf(scene), 1, 1e-6);
        for (int i = 0; i < 2; i++) EXPECT_EQ(normalOf(scene.primitives[i]), vec3(0, 0, 1)) << mode;
        EXPECT_EQ(scene.normals.size(), 0u); // none in the file: flat
    }
}

TEST(Gltf, NumbersOfAllTypesAreTheSameSquare) {
    const auto expectSquare = [](auto one, auto... fraction) {
        using T = decltype(one);
        GltfText model = squareModel();
        const T zero = 0;
        model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
            model.add<T>({zero, zero, zero, one, zero, zero, one, one, zero, zero, one, zero}, "VEC3", fraction...);
        EXPECT_NEAR(areaOf(loadModel(model)), 1, 1e-6);
    };
    const json normalized = {{"normalized", true}};
    expectSquare(1.0f);
    expectSquare(static_cast<signed char>(1));
    expectSquare(static_cast<signed char>(127), normalized);
    expectSquare(static_cast<unsigned char>(255), normalized);
    expectSquare(static_cast<short>(32767), normalized);
    expectSquare(static_cast<unsigned short>(65535), normalized);
    for (const int type : {5121, 5123, 5125}) {
        GltfText model = squareModel();
        json& indices = model.json["meshes"][0]["primitives"][0]["indices"];
        if (type == 5121) indices = model.add<unsigned char>({0, 1, 2, 0, 2, 3}, "SCALAR");
        if (type == 5125) indices = model.add<unsigned>({0, 1, 2, 0, 2, 3}, "SCALAR");
        EXPECT_NEAR(areaOf(loadModel(model)), 1, 1e-6);
    }
}

TEST(Gltf, SparseInterleavedAndSharedAccessors) {
    GltfText model = squareModel();
    json& accessor = model.json["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", model.addView<unsigned short>({1, 2})}, {"componentType", 5123}}},
                          {"values", {{"bufferView", model.addView<float>({3, 0, 0, 3, 1, 0})}}}};
    EXPECT_NEAR(areaOf(loadModel(model)), 3, 1e-6);
    accessor.erase("bufferView"); // all 0 but what is sparse: the triangle 0, 1, 2, and one without area
    EXPECT_NEAR(areaOf(loadModel(model)), 1.5, 1e-6);

    model = squareModel();
    const auto rows = model.addView<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 1, 1, 0, 9, 0, 1, 0});
    model.json["bufferViews"][rows]["byteStride"] = 16;
    model.json["accessors"][0]["bufferView"] = rows;
    model.json["accessors"][0]["byteOffset"] = 4;
    EXPECT_NEAR(areaOf(loadModel(model)), 1, 1e-6);
}

// A mirrored node turns windings, so that the outer side stays outside; normals follow the inverse transpose.
TEST(Gltf, NodesScaleTurnAndMirror) {
    GltfText model = squareModel();
    const float s = std::numbers::sqrt2_v<float> / 2;
    model.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        model.add<float>({0, s, s, 0, s, s, 0, s, s, 0, s, s}, "VEC3");
    model.json["nodes"] =
        json::parse(R"([{"scale": [-1, 2, 4], "children": [1]}, {"mesh": 0, "translation": [1, 2, 3]}])");
    const Scene scene = loadModel(model);
    EXPECT_NEAR(areaOf(scene), 2, 1e-6);
    EXPECT_EQ(normalOf(scene.primitives[0]), vec3(0, 0, 1));
    const vec3 normal = scene.normals[0].a, expected = glm::normalize(vec3(0, 0.5f, 0.25f));
    EXPECT_NEAR(glm::distance(normal, expected), 0, 1e-6);
    EXPECT_THAT(placesOf(scene), Contains(dvec3(-1, 4, 12)));
}

TEST(Gltf, WithoutACameraTheWholeIsSeenFromTheFront) {
    const Scene scene = loadModel(squareModel());
    const vec3 forward = glm::normalize(scene.view.target - scene.view.origin);
    EXPECT_LT(forward.z, -0.9f);
    EXPECT_LT(forward.y, -0.1f);
    for (const dvec3& place : placesOf(scene)) {
        const vec3 seen = vec3{place - scene.coordinates.world(scene.view.origin)};
        EXPECT_GT(glm::dot(glm::normalize(seen), forward), std::cos(scene.view.fieldOfView / 2));
    }
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("model.glb: /: no camera")));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("model.glb: /: no light")));
    EXPECT_EQ(scene.lights.size(), 1u);
}

// Blender writes 543.5 cd for a point of 10 W: 0.1989 W/m^2 at 2 m; and 683 lx for a sun of 1 W/m^2.
TEST(Gltf, LampsHaveTheirIrradiance) {
    GltfText model = squareModel();
    model.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    json& lamp = model.json["extensions"]["KHR_lights_punctual"]["lights"][0];
    const auto irradiance = [&](const json& import, double distance) {
        writeScene(model.glb(), "model.glb");
        json scene = importing(import);
        scene["materials"]["black"] = {{"type", "diffuse"}, {"albedo", 0}};
        const Scene loaded = loadJson(scene);
        const Light& light = loaded.lights.at(0);
        if (light.kind == LIGHT_POINT) return light.radiance.x / (distance * distance);
        const double size =
            light.kind == LIGHT_SUN ? double{light.u.x} : light.u.x / distance; // sine of half its angle
        return std::numbers::pi * light.radiance.x * size * size;
    };
    lamp = {{"type", "point"}, {"intensity", 543.5}};
    EXPECT_NEAR(irradiance({{"file", "model.glb"}, {"lampRadius", 0.05}}, 2), 0.1989, 1e-4);
    EXPECT_NEAR(irradiance("model.glb", 2), 0.1989, 1e-4); // a point
    lamp["intensity"] = 10 / (4 * std::numbers::pi);
    EXPECT_NEAR(irradiance({{"file", "model.glb"}, {"lampRadius", 0.05}, {"lights", "unitless"}}, 2), 0.1989, 1e-4);
    lamp["intensity"] = 10;
    EXPECT_NEAR(irradiance({{"file", "model.glb"}, {"lampRadius", 0.05}, {"lights", "raw"}}, 2), 0.1989, 1e-4);
    lamp = {{"type", "directional"}, {"intensity", 683}};
    EXPECT_NEAR(irradiance("model.glb", 0), 1, 1e-4);
}

TEST(Gltf, MaterialsAreStandardOnesOrGlass) {
    GltfText model = squareModel();
    model.json["meshes"][0]["primitives"][0]["material"] = 0;
    const auto materialOf = [&](const char* text, const json& more = json::object()) {
        model.json["materials"] = {json::parse(text)};
        writeScene(model.glb(), "model.glb");
        json import = more;
        import["file"] = "model.glb";
        const Scene scene = loadJson(importing(import));
        return scene.materials[scene.primitives[0].material];
    };
    Material m =
        materialOf(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.75, 1], "metallicFactor": 0}})");
    EXPECT_EQ(m.kind, MATERIAL_STANDARD);
    EXPECT_EQ(m.color, vec3(0.25, 0.5, 0.75));
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.alpha, 1);
    EXPECT_NEAR(m.normalIncidence.x, 0.04, 1e-7);
    m = materialOf(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 30, 0]}}})");
    EXPECT_EQ(m.alpha, 1e-3f);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.grazing, 0.5f);
    EXPECT_NEAR(m.normalIncidence.x, 0.02, 1e-7);
    EXPECT_EQ(m.normalIncidence.y, 0.5f);
    EXPECT_EQ(m.normalIncidence.z, 0);
    m = materialOf(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.1, 0.2, 0.3, 1], "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.5}}})");
    EXPECT_EQ(m.color, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.normalIncidence, vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(m.alpha, 0.25f);
    m = materialOf(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.5]}, "alphaMode": "BLEND",
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {}}})"); // nothing of the newer model counts
    EXPECT_EQ(m.color, vec3(1));
    EXPECT_EQ(m.seeThrough, 0);
    for (const auto& [cutoff, seeThrough] : {std::pair{0.5, 0.0f}, {1.0, 0.0f}, {1.5, 1.0f}}) {
        const json masked = {{"alphaMode", "MASK"}, {"alphaCutoff", cutoff}};
        EXPECT_EQ(materialOf(masked.dump().c_str()).seeThrough, seeThrough) << cutoff;
    }
    const char* const glass = R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.25}}})";
    m = materialOf(glass);
    EXPECT_EQ(m.kind, MATERIAL_GLASS);
    EXPECT_EQ(m.ior, 1.25f);
    EXPECT_EQ(materialOf(glass, {{"glass", "thin"}}).kind, MATERIAL_THIN_GLASS);
    EXPECT_EQ(materialOf(glass, {{"glass", "thin"}}).ior, 1.25f);
    m = materialOf("{}"); // a metal of roughness 1
    EXPECT_EQ(m.kind, MATERIAL_STANDARD);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.alpha, 1);
}

TEST(Gltf, EmissionIsRadianceAndSidesAreKept) {
    GltfText model = fullModel();
    Scene scene = loadModel(model);
    const auto light = std::ranges::find(scene.lights, uint{LIGHT_TRIANGLE}, &Light::kind);
    ASSERT_NE(light, scene.lights.end());
    EXPECT_EQ(light->radiance, vec3(8, 4, 0));
    EXPECT_EQ(light->twoSided, 0u);
    model.json["materials"][1]["doubleSided"] = true;
    scene = loadModel(model);
    EXPECT_EQ(std::ranges::find(scene.lights, uint{LIGHT_TRIANGLE}, &Light::kind)->twoSided, 1u);
}

// What the scene file says itself comes on top: camera, materials by name, shapes.
TEST(Gltf, AnImportIsPartOfAScene) {
    writeScene(fullModel().glb(), "model.glb");
    json scene = importing({{"file", "model.glb"}, {"transform", {{{"scale", 2}}}}});
    scene["materials"]["matt"] = {{"type", "mirror"}, {"reflectance", 0.5}};
    scene["shapes"].push_back(
        {{"type", "sphere"}, {"center", {0, 9, 0}}, {"radius", 1}, {"material", "lamp"}}); // of the model
    const Scene loaded = loadJson(scene);
    EXPECT_EQ(loaded.view.fieldOfView, glm::radians(40.0f));
    EXPECT_EQ(loaded.settings.size, uvec2(8, 4));
    EXPECT_EQ(loaded.materials[loaded.primitives[0].material].kind, MATERIAL_MIRROR);
    EXPECT_THAT(placesOf(loaded), Contains(dvec3(4, 4, 0)));
    scene.erase("camera");
    scene["import"]["camera"] = "eye";
    EXPECT_EQ(loadJson(scene).view.fieldOfView, 0.7f);
    scene["import"]["camera"] = 1;
    EXPECT_THAT(errorOf(scene),
                HasSubstr("scene.json: /import/camera: found 1, which is no camera of the file's scene"));
}

TEST(Gltf, IsAMeshOfAShape) {
    writeScene(fullModel().glb(), "model.glb");
    json scene = smallScene();
    scene["shapes"].push_back({{"type", "mesh"}, {"file", "model.glb"}, {"material", "steel"}});
    const Scene loaded = loadJson(scene);
    EXPECT_EQ(loaded.triangleCount, 9u + 2);
    EXPECT_EQ(loaded.files.size(), 2u);
}

// A buffer in a file of its own, in a data URI and in a .glb give the same scene; its file counts for the identity.
TEST(Gltf, BuffersCountForTheIdentity) {
    GltfText model = squareModel();
    const auto hashOf = [](const Scene& scene) { return identityOf(scene, scene.settings).at("sceneHash"); };
    writeScene(model.bytes, "a b.bin");
    const Scene outside = loadScene(writeScene(model.gltf("a%20b.bin"), "outside.gltf"));
    EXPECT_EQ(outside.files.size(), 2u);
    const std::string hash = hashOf(outside);
    EXPECT_EQ(hash, hashOf(loadModel(model)));
    std::string base64;
    for (std::size_t i = 0; i < model.bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < model.bytes.size() ? static_cast<unsigned char>(model.bytes[i + k]) : 0);
        for (int k = 3; k >= 0; k--)
            base64 += "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"[bits >> 6 * k & 63];
    }
    EXPECT_EQ(hash, hashOf(loadScene(
                        writeScene(model.gltf("data:application/octet-stream;base64," + base64), "inside.gltf"))));
    model.bytes[4 * 3 + 3] = 0x40; // the second vertex moves
    writeScene(model.bytes, "a b.bin");
    const Scene other = loadScene(outside.files[0]);
    EXPECT_NE(hash, hashOf(other));
    EXPECT_THAT(differences(identityOf(outside, outside.settings), identityOf(other, other.settings)),
                testing::ElementsAre("scene: what the file \"a b.bin\" holds"));
}

/// The full model with one value changed or removed.
GltfText changed(const char* pointer, const json& value) {
    GltfText model = fullModel();
    const json::json_pointer place{pointer};
    if (value.is_discarded()) model.json[place.parent_pointer()].erase(place.back());
    else model.json[place] = value;
    return model;
}

TEST(Gltf, WhatIsWrongHasItsPlace) {
    const std::tuple<const char*, json, const char*> wrong[] = {
        {"/asset/version", "1.0", "/asset/version: found version \"1.0\""},
        {"/extensionsRequired/0", "EXT_other", "/extensionsRequired/0: the file requires the extension \"EXT_other\""},
        {"/scene", 3, "/scene: found 3; allowed is an integer from 0 to 0"},
        {"/nodes/4/children", {0}, "/nodes/4/children/0: found node 0 a second time"},
        {"/nodes/0/mesh", 7, "/nodes/0/mesh: found 7"},
        {"/nodes/1/rotation", {0, 0, 0, 0}, "/nodes/1/rotation: found a rotation of length 0"},
        {"/meshes/0/primitives/0/indices", 0, "/accessors/0/componentType: found 5126; allowed of indices"},
        {"/accessors/0/count", 2147483648u, "/accessors/0: found 2147483648 elements"},
        {"/accessors/0/count", 3, "/attributes/NORMAL: found 4 normals; there are 3 positions"},
        {"/accessors/0/type", "VEC4", "/accessors/0/type: found \"VEC4\"; needed here is \"VEC3\""},
        {"/accessors/0/byteOffset", 4, "/accessors/0: found 4 elements, which end at byte 52; the buffer view has 48"},
        {"/accessors/4/sparse/count", 4, "/accessors/4/sparse/count: found 4"},
        {"/bufferViews/0/byteLength", 1e6, "/bufferViews/0: found bytes 0 to 1000000 of a buffer"},
        {"/bufferViews/0/byteStride", 4, "/bufferViews/0: found a \"byteStride\" of 4"},
        {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: found 1"},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor/0", 1.5,
         "/materials/0/pbrMetallicRoughness/baseColorFactor/0: found 1.5"},
        {"/cameras/0/perspective/yfov", 0, "/cameras/0/perspective/yfov: found 0"},
        {"/extensions/KHR_lights_punctual/lights/0/type", "beam",
         "/extensions/KHR_lights_punctual/lights/0/type: found \"beam\""},
        {"/nodes/0/scale", {1e38, 1e38, 1e38}, "model.glb: /"}};
    for (const auto& [pointer, value, message] : wrong)
        EXPECT_THAT(errorOf(writeScene(changed(pointer, value).glb(), "model.glb")), HasSubstr(message)) << pointer;
    GltfText square = squareModel();
    square.json["accessors"][0]["count"] = 3;
    EXPECT_THAT(errorOf(writeScene(square.glb(), "model.glb")),
                HasSubstr("/accessors/1: found 3 at place 5; there are 3 vertices"));
    const std::string glb = fullModel().glb();
    EXPECT_THAT(errorOf(writeScene(glb.substr(0, 300), "model.glb")),
                HasSubstr("model.glb: byte 8: the file says that it has"));
    EXPECT_THAT(errorOf(writeScene("glTF", "model.glb")), HasSubstr("model.glb: byte 4: the file ends here"));
}

/// The corners of each triangle, the least first, in the order of numbers.
std::vector<std::array<std::array<double, 3>, 3>> trianglesOf(const Scene& scene) {
    std::vector<std::array<std::array<double, 3>, 3>> all;
    const std::vector<dvec3> places = placesOf(scene);
    for (std::size_t i = 0; i < places.size(); i += 3) {
        all.emplace_back();
        for (std::size_t k = 0; k < 3; k++) all.back()[k] = {places[i + k].x, places[i + k].y, places[i + k].z};
        std::ranges::rotate(all.back(), std::ranges::min_element(all.back()));
    }
    std::ranges::sort(all);
    return all;
}

TEST(Gltf, CompressedMeshesAreThoseOfPlainOnes) {
    const auto plain = trianglesOf(loadModel(packedModel(Packing::none)));
    ASSERT_EQ(plain.size(), 8u);
    for (const Packing packing : {Packing::dracoSequential, Packing::dracoEdgebreaker, Packing::meshopt})
        EXPECT_EQ(trianglesOf(loadModel(packedModel(packing))), plain) << int(packing);
}

TEST(Gltf, WhatIsWrongWithCompressedMeshesHasItsPlace) {
    const std::string view = "/bufferViews/0/extensions/EXT_meshopt_compression", primitive = "/meshes/0/primitives/0";
    const std::tuple<Packing, std::string, json, std::string> wrong[] = {
        {Packing::meshopt, view + "/count", 200, view + ": found bytes that meshoptimizer cannot unpack"},
        {Packing::meshopt, view + "/count", 4'000'000'000u, view + "/count: found 4000000000 elements of 12 bytes in"},
        {Packing::meshopt, view + "/byteStride", 10, view + "/byteStride: found 10; allowed are multiples of 4"},
        {Packing::meshopt, view + "/filter", "QUATERNION", view + "/filter: found \"QUATERNION\" beside"},
        {Packing::meshopt, view + "/byteLength", 1e6, view + ": found bytes 0 to 1000000 of a buffer"},
        {Packing::dracoSequential, "/accessors/0/count", 8, "/accessors/0: found 8 elements; the mesh has 9"},
        {Packing::dracoEdgebreaker, "/accessors/1/count", 4'000'000'000u, "/accessors/1: found 4000000000 elements"},
        {Packing::dracoEdgebreaker, primitive + "/extensions/KHR_draco_mesh_compression/attributes/POSITION", 1,
         "/attributes/POSITION: found 1; the mesh has no such attribute"},
        {Packing::dracoEdgebreaker, "/accessors/0/type", "VEC2", "the accessor has elements of another length"}};
    for (const auto& [packing, pointer, value, message] : wrong) {
        GltfText model = packedModel(packing);
        model.json[json::json_pointer(pointer)] = value;
        EXPECT_THAT(errorOf(writeScene(model.glb(), "model.glb")), HasSubstr(message)) << pointer;
    }
    GltfText model = packedModel(Packing::dracoSequential);
    model.bytes[6] = 9;
    EXPECT_THAT(errorOf(writeScene(model.glb(), "model.glb")), HasSubstr("/bufferViews/0: found version 2.9 of Draco"));
}

TEST(Gltf, BuffersAreFilesNotAddressesOrPipes) {
    const GltfText model = squareModel();
    const auto refusal = [&](const char* uri) { return errorOf(writeScene(model.gltf(uri), "model.gltf")); };
    EXPECT_THAT(refusal("https://example.org/a.bin"),
                HasSubstr("/buffers/0/uri: found the URI \"https://example.org/a.bin\""));
    EXPECT_THAT(refusal("/dev/zero"), HasSubstr("/dev/zero: this is a device or a pipe"));
    EXPECT_THAT(refusal("none.bin"), HasSubstr("/buffers/0/uri: "));
    EXPECT_THAT(refusal("data:;base64,AAAA"), HasSubstr("/buffers/0: found a buffer of"));
    EXPECT_THAT(refusal("data:;base64,A*AA"), HasSubstr("/buffers/0/uri: found \"*\" in base64"));
}

// A head with seams, mirrored places and sharp edges: its tangents as Blender's MikkTSpace computes and exports them.
TEST(Gltf, TangentsAreThoseOfBlender) {
    Mesh mesh = loadMesh(VKPM_TEST_DATA "/tangents.glb", Smoothness::fromFile);
    const std::vector<Tangents> computed = mikkTangents(mesh, 0);
    ASSERT_EQ(computed.size(), mesh.tangents.size());
    ASSERT_GT(computed.size(), 150u);
    int behind = 0, off = 0;
    double most = 0;
    for (std::size_t i = 0; i < computed.size(); i++) {
        const Tangents &found = computed[i], &expected = mesh.tangents[i];
        behind += expected.side < 0;
        EXPECT_EQ(found.side, expected.side) << i;
        for (const auto& [f, e] : {std::pair(found.a, expected.a), {found.b, expected.b}, {found.c, expected.c}}) {
            const double angle = glm::length(glm::cross(glm::dvec3{f}, glm::dvec3{e}));
            most = std::max(most, angle);
            off += angle > 1e-3 || glm::dot(f, e) < 0;
        }
    }
    std::printf("%d of %zu triangles are mirrored; the largest angle is %.1e\n", behind, computed.size(), most);
    EXPECT_GT(behind, 20);
    EXPECT_EQ(off, 0);
}

// A chain of a hundred thousand nodes is walked without recursion.
TEST(Gltf, NodesMayBeDeep) {
    GltfText model = squareModel();
    json nodes = json::array();
    for (int i = 0; i < 100'000; i++) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    model.json["nodes"] = nodes;
    EXPECT_EQ(loadModel(model).triangleCount, 2u);
}

} // namespace
} // namespace vkpm
