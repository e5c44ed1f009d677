/// glTF files that are odd, but allowed, and what is said of them.
#include "gltf_text.h"
#include "scene_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace vkpm {
namespace {

using testing::Contains;
using testing::HasSubstr;

// By any scheme of letters, in base64 or not; names as they are, or with percent signs.
TEST(OddGltf, BuffersOfAllReferences) {
    const GltfText model = squareModel();
    writeScene(model.bytes, "ein Würfel.bin");
    std::string percent;
    for (const unsigned char byte : model.bytes) percent += fmt::format("%{:02x}", byte);
    for (const std::string& uri : {std::string{"ein Würfel.bin"}, std::string{"ein%20W%C3%BCrfel.bin"},
                                   "data:application/octet-stream," + percent, "DATA:," + percent})
        EXPECT_EQ(loadScene(writeScene(model.gltf(uri), "model.gltf")).triangleCount, 2u) << uri.substr(0, 30);
}

// What is left out of a file, and a version that it asks for.
TEST(OddGltf, ScenesAnimationsAndVersions) {
    GltfText model = squareModel();
    model.json["scenes"].push_back({{"nodes", {0}}});
    model.json["animations"] = {{{"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}}};
    const Scene scene = loadScene(writeScene(model.glb(), "model.glb"));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("/scenes: all scenes but the file's default one are left out")));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("/animations: animations are left out")));
    model.json["asset"]["minVersion"] = "2.1";
    EXPECT_THAT(errorOf(writeScene(model.glb(), "model.glb")),
                HasSubstr("/asset/minVersion: the file requires version \"2.1\" of glTF"));
}

// What emits may transmit, and be opaque in part.
TEST(OddGltf, EmissionBesideTransmissionAndOpacity) {
    GltfText model = squareModel();
    model.json["materials"] = nlohmann::json::parse(R"([{"emissiveFactor": [1, 0.5, 0], "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25], "metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}])");
    model.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene scene = loadScene(writeScene(model.glb(), "model.glb"));
    const Primitive& triangle = scene.primitives[0];
    const Material& material = scene.materials[triangle.material];
    EXPECT_EQ(material.kind, MATERIAL_GLASS);
    EXPECT_EQ(material.seeThrough, 0.75f);
    ASSERT_NE(triangle.light, NONE);
    EXPECT_EQ(scene.lights[triangle.light].radiance, vec3(1, 0.5f, 0));
    EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("emits"))));
}

} // namespace
} // namespace vkpm
