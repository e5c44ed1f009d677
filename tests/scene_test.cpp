/// The scene loader: what it makes of cameras, materials, shapes, transforms, meshes and lights.
#include "render/features.h"
#include "scene/bounding_sphere.h"
#include "scene/lights.h"
#include "scene/luminance.h"
#include "scene/scene.h"
#include "scene_text.h"
#include <cstring>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <ranges>

namespace vkpm {
namespace {

using glm::dvec3;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
constexpr float pi = std::numbers::pi_v<float>;

std::filesystem::path data(const std::string& name) { return std::filesystem::path{VKPM_TEST_DATA} / name; }

void expectNear(vec3 found, vec3 expected, float tolerance = 1e-6f) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "component " << i;
}

vec3 normalOf(const Primitive& p) { return glm::normalize(glm::cross(p.b - p.a, p.c - p.a)); }

/// The small scene with its first shape replaced.
json withShape(const json& shape) {
    json scene = smallScene();
    scene["shapes"][0] = shape;
    return scene;
}

json mesh(const std::string& name) { return {{"type", "mesh"}, {"file", data(name).string()}, {"material", "grey"}}; }

/// Six times the volume that triangles enclose; positive if they face outward.
double signedVolume(const Scene& scene, std::size_t count) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Primitive& p = scene.primitives[i];
        sum += glm::dot(dvec3{p.a}, glm::cross(dvec3{p.b}, dvec3{p.c}));
    }
    return sum;
}

TEST(Scene, BoxHasTheNumbersOfItsReference) {
    const Scene box = loadScene(std::filesystem::path{VKPM_SCENES} / "box.json");
    EXPECT_EQ(box.name, "box");
    EXPECT_EQ(box.triangleCount, 12u);
    ASSERT_EQ(box.primitives.size(), 14u);
    EXPECT_EQ(box.materials.size(), 6u); // with the light's black
    expectNear(normalOf(box.primitives[0]), {0, 1, 0});
    expectNear(normalOf(box.primitives[2]), {0, -1, 0});
    expectNear(normalOf(box.primitives[4]), {0, 0, 1});
    expectNear(normalOf(box.primitives[6]), {1, 0, 0});
    expectNear(normalOf(box.primitives[8]), {-1, 0, 0});

    ASSERT_EQ(box.lights.size(), 1u);
    const Light& light = box.lights[0];
    EXPECT_EQ(light.kind, LIGHT_RECTANGLE);
    EXPECT_EQ(light.area, 0.25f);
    EXPECT_EQ(box.lightCdf, std::vector<float>{1.0f});
    EXPECT_EQ(light.twoSided, 0u);
    expectNear(glm::cross(light.u, light.v), {0, -0.25f, 0});
    expectNear(box.flux, pi * 0.25f * vec3{17, 12, 4}, 1e-5f);
    EXPECT_EQ(box.primitives[10].light, 0u);
    EXPECT_EQ(box.primitives[11].light, 0u);
    expectNear(box.materials[box.primitives[10].material].color, vec3{0});

    ASSERT_EQ(box.targets.size(), 2u);
    expectNear(box.targets[1].center, {0.45f, -0.65f, 0.25f});
    EXPECT_EQ(box.targets[1].radius, 0.35f);
    expectNear(box.bounds.low, vec3{-1});
    expectNear(box.bounds.high, vec3{1});
}

TEST(Scene, ShippedScenesLoadWithoutWarnings) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator{VKPM_SCENES}) {
        if (!entry.is_regular_file()) continue;
        EXPECT_LT(entry.file_size(), 1u << 20u) << entry.path();
        if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema") continue;
        const Scene scene = loadScene(entry.path());
        EXPECT_THAT(scene.warnings, testing::IsEmpty()) << entry.path();
        EXPECT_EQ(scene.text.find("{\n  \"about\": \""), 0u) << entry.path();
        EXPECT_THAT(scene.text, HasSubstr("\n  \"$schema\": \"scene.schema.json\",\n")) << entry.path();
        ++scenes;
    }
    EXPECT_GE(scenes, 5);
}

TEST(Scene, SettingsOverrideDefaults) {
    const Settings settings = loadJson(smallScene()).settings;
    EXPECT_EQ(settings.size, uvec2(8, 4));
    EXPECT_EQ(settings.exposure, 1.0f);
    EXPECT_EQ(settings.passes, 2u);
    EXPECT_EQ(settings.photons, 10u);
    EXPECT_EQ(settings.causticPhotons, 10u);
    EXPECT_EQ(settings.radius, 0.1f);
    EXPECT_EQ(settings.causticRadius, 0.1f);
    EXPECT_EQ(settings.nearest, 5u);
    EXPECT_EQ(settings.pixelSamples, 3u);
    EXPECT_EQ(settings.gatherRays, 2u);
    EXPECT_EQ(settings.kernel, DENSITY_KERNEL_CONE);
    EXPECT_TRUE(settings.schlick);
    EXPECT_EQ(settings.seed, 7u);

    json plain = smallScene();
    for (const char* key : {"film", "settings"}) plain.erase(key);
    plain["camera"].erase("fieldOfView");
    const Scene defaults = loadJson(plain);
    EXPECT_EQ(defaults.settings.size, Settings{}.size);
    EXPECT_FALSE(defaults.settings.radius.has_value());
    EXPECT_EQ(defaults.view.fieldOfView, View{}.fieldOfView);
}

TEST(Scene, ByteOrderMarkAndCarriageReturnsAreAccepted) {
    std::string text = smallScene().dump(1);
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
    EXPECT_EQ(loadText("\xEF\xBB\xBF" + text).primitives.size(), 3u);
}

TEST(Scene, MaterialsKeepTheirKindAndTheRatioOfIndices) {
    json scene = smallScene();
    scene["materials"]["water"] = {{"type", "glass"}, {"ior", 1.0}, {"exteriorIor", 2}, {"tint", {0.1, 0.2, 0.3}}};
    const std::vector<Material> materials = loadJson(scene).materials; // grey, steel, water, black
    EXPECT_EQ(materials[0].kind, MATERIAL_DIFFUSE);
    expectNear(materials[0].color, vec3{0.5f});
    EXPECT_EQ(materials[1].kind, MATERIAL_MIRROR);
    expectNear(materials[1].color, {0.9f, 0.8f, 0.7f});
    EXPECT_EQ(materials[2].kind, MATERIAL_GLASS);
    expectNear(materials[2].color, {0.1f, 0.2f, 0.3f});
    EXPECT_EQ(materials[2].ior, 0.5f);
    scene["materials"]["steel"] = {{"type", "metal"}, {"reflectance", {0.9, 0.8, 0.7}}, {"roughness", 0.03}};
    const Material polished = loadJson(scene).materials[1];
    EXPECT_EQ(std::memcmp(&polished, &materials[1], sizeof polished), 0);
}

TEST(Scene, TransformsAreAppliedInOrder) {
    const json steps =
        json::parse(R"([{"scale": 2}, {"rotate": {"axis": [0, 0, 3], "degrees": 90}}, {"translate": [5, 0, 0]},
                                       {"matrix": [1, 0, 0, 0,  0, 1, 0, 10,  0, 0, 1, 0,  0, 0, 0, 1]}])");
    const json sphere{
        {"type", "sphere"}, {"center", {1, 0, 0}}, {"radius", 0.5}, {"material", "steel"}, {"transform", steps}};
    const Scene scene = loadJson(withShape(sphere));
    expectNear(scene.primitives.back().a, {5, 12, 0});
    EXPECT_NEAR(scene.primitives.back().b.x, 1, 1e-6);
    ASSERT_EQ(scene.targets.size(), 1u);
    EXPECT_EQ(scene.targets[0].radius, scene.primitives.back().b.x);
}

TEST(Scene, MirroredShapesKeepTheirOutside) {
    for (const json& scale : {json{-1}, json{{1, -2, 3}}, json{{1, 1, -1}}, json{{1, 2, 3}}, json{{-1, -1, 1}}}) {
        json cube = mesh("cube.obj");
        cube["transform"] = {{{"scale", scale.is_array() && scale.size() == 1 ? scale[0] : scale}}};
        const Scene scene = loadJson(withShape(cube));
        EXPECT_GT(signedVolume(scene, 12), 0) << scale;
        for (std::size_t i = 0; i < 12; ++i)
            expectNear(scene.normals[scene.primitives[i].normals].b, normalOf(scene.primitives[i]));

        json floor{
            {"type", "rectangle"}, {"corner", {0, -1, 0}}, {"edges", {{0, 0, 1}, {1, 0, 0}}}, {"material", "grey"}};
        floor["transform"] = cube["transform"];
        const Primitive p = loadJson(withShape(floor)).primitives[0];
        EXPECT_EQ(normalOf(p).y, p.a.y < 0 ? 1.0f : -1.0f) << scale; // away from y = -1, towards the origin
    }
}

TEST(Scene, MeshNormalsAreThoseOfTheFileComputedOrNone) {
    const Scene fromFile = loadJson(withShape(mesh("cube.obj")));
    EXPECT_EQ(fromFile.triangleCount, 14u);
    EXPECT_EQ(fromFile.normals.size(), 12u);
    EXPECT_NE(sceneFeatures(fromFile, {}).hasSmoothNormals, 0u);

    json flat = mesh("cube.obj");
    flat["smooth"] = false;
    EXPECT_TRUE(loadJson(withShape(flat)).normals.empty());
    EXPECT_TRUE(loadJson(withShape(mesh("plain_cube.obj"))).normals.empty());

    // By angles, the three faces at a cube's corner weigh the same however they are triangulated.
    json smooth = mesh("plain_cube.obj");
    smooth["smooth"] = true;
    const Scene computed = loadJson(withShape(smooth));
    ASSERT_EQ(computed.normals.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
        const Primitive& p = computed.primitives[i];
        expectNear(computed.normals[p.normals].a, glm::normalize(p.a));
        expectNear(computed.normals[p.normals].c, glm::normalize(p.c));
    }
}

/// The scene of a mesh of this text.
Scene loadMeshText(const std::string& text, bool smooth = true) {
    json shape = mesh("cube.obj");
    shape["file"] = writeScene(text, "mesh.obj").string();
    if (!smooth) shape["smooth"] = false;
    return loadJson(withShape(shape));
}
std::string refusalOfMesh(const std::string& text) {
    try {
        (void)loadMeshText(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// As exporters write them.
TEST(Scene, MeshesOfOtherProgramsAreRead) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for (const std::string& lines :
         {corners + "f 1 2 \\\n 3 4\n", corners + "f 1 \\\r\n2 \\\r\n3 4", corners + "f 1//0 2//0 3//0 4//0",
          corners + "f 1/0/0 2/0/0 3/0/0 4/0/0", corners + "f 1 2 3 4 \\",
          std::string("v 0 0 \\\n0\n") + corners.substr(8) + "f 1 2 3 4"}) {
        const Scene scene = loadMeshText(lines);
        EXPECT_EQ(scene.triangleCount, 4u) << lines; // two, and the light's
        EXPECT_TRUE(scene.normals.empty() && scene.warnings.empty()) << lines;
    }
    EXPECT_THAT(refusalOfMesh(corners + "f 1 \\\n2 9\n"),
                HasSubstr("mesh.obj:5: a face refers to vertex 9")); // the line where it begins
    EXPECT_THAT(refusalOfMesh(corners + "f 1 \\\n2 3\nf 1 2 9\n"), HasSubstr("mesh.obj:7: a face refers to vertex 9"));
    EXPECT_THAT(refusalOfMesh(corners + "f 0 1 2\n"), HasSubstr("mesh.obj:5: found \"0\""));

    const Scene odd = loadMeshText(corners + "f 1 2\nf 1 2 3 4\nf 3\n");
    EXPECT_EQ(odd.triangleCount, 4u);
    EXPECT_THAT(odd.warnings,
                ElementsAre(AllOf(HasSubstr("/shapes/0/file"), HasSubstr("2 faces have fewer than 3 corners"))));

    const Scene many = loadMeshText(
        corners + "usemtl glass\nf 1 2 3\nusemtl white paint \nf 1 3 4\nusemtl glass\nf 1 2 4\nusemtl unused\n");
    EXPECT_THAT(many.warnings,
                ElementsAre(AllOf(HasSubstr("use 2 materials"), HasSubstr("\"glass\""), HasSubstr("\"white paint\""))));
    EXPECT_TRUE(loadMeshText(corners + "usemtl glass\nf 1 2 3\nusemtl glass\nf 1 3 4\n").warnings.empty());
}

/// What is said of a glass mesh of a cube's corners and these faces.
json sceneOfGlass(const std::string& faces, const json& transform, const json& more) {
    json shape = mesh("cube.obj");
    shape["file"] =
        writeScene("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n" + faces, "mesh.obj")
            .string();
    shape["material"] = "water";
    shape["name"] = "pane";
    if (!transform.empty()) shape["transform"] = transform;
    json scene = smallScene();
    scene["shapes"].erase(0);
    scene["shapes"].push_back(shape);
    for (const json& one : more) scene["shapes"].push_back(one);
    return scene;
}

std::vector<std::string> saidOfGlass(const std::string& faces, const json& transform = json::array(),
                                     const json& more = json::array()) {
    return loadJson(sceneOfGlass(faces, transform, more)).warnings;
}

TEST(Scene, GlassThatBoundsNoSolidIsNamed) {
    const std::string cube = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
                      sheet = "f 1 2 3 4\n";
    EXPECT_THAT(saidOfGlass(cube), testing::IsEmpty());
    EXPECT_THAT(saidOfGlass(cube, json::parse(R"([{"scale": [1, -2, 3]}])")), testing::IsEmpty()) << "mirrored";
    EXPECT_THAT(saidOfGlass(sheet), ElementsAre(AllOf(HasSubstr("/shapes/1: \"pane\": the glass is open, 4 edges"))));
    EXPECT_THAT(saidOfGlass(cube.substr(cube.find('\n') + 1)), ElementsAre(HasSubstr("the glass is open, 4 edges")));
    EXPECT_THAT(saidOfGlass("f 1 2 3 4\n" + cube.substr(cube.find('\n') + 1)),
                ElementsAre(HasSubstr("face different ways at 4 edges")));
    EXPECT_THAT(saidOfGlass("f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n"),
                ElementsAre(HasSubstr("inside out")));
    EXPECT_THAT(saidOfGlass(cube, json::parse(R"([{"scale": [1, 1e-5, 1]}, {"translate": [0, 3, 0]}])")),
                ElementsAre(HasSubstr("the glass is 1e-05 thick")));
    EXPECT_THAT(saidOfGlass(cube, json::parse(R"([{"scale": [1, 1e-5, 1]}, {"scale": 1e9}])")),
                testing::Not(testing::IsEmpty()));

    // Water between walls, and what rectangles close.
    const auto wall = [](vec3 corner, vec3 u, vec3 v, const char* material) {
        const auto list = [](vec3 x) { return json{x.x, x.y, x.z}; };
        return json{
            {"type", "rectangle"}, {"corner", list(corner)}, {"edges", {list(u), list(v)}}, {"material", material}};
    };
    const json walls{wall({0, 0, -1}, {0, 1, 0}, {0, 0, 2}, "grey"), wall({1, 0, -1}, {0, 1, 0}, {0, 0, 2}, "grey"),
                     wall({0, 0, -1}, {1, 0, 0}, {0, 0, 2}, "grey"), wall({0, 1, -1}, {1, 0, 0}, {0, 0, 2}, "grey")};
    EXPECT_THAT(saidOfGlass(sheet, json::array(), walls), testing::IsEmpty());
    EXPECT_THAT(saidOfGlass(cube, json::array(), json{wall({3, 0, 0}, {1, 0, 0}, {0, 1, 0}, "water")}),
                ElementsAre(HasSubstr("/shapes/2: the glass is open")));
    EXPECT_THAT(
        saidOfGlass(
            cube, json::array(),
            json{wall({3, 0, 0}, {1, 0, 0}, {0, 1, 0}, "water"), wall({3, 0, 0}, {0, 1, 0}, {0, 0, 1}, "water"),
                 wall({3, 0, 0}, {0, 0, 1}, {1, 0, 0}, "water"), wall({4, 1, 1}, {-1, 0, 0}, {0, 0, -1}, "water"),
                 wall({4, 1, 1}, {0, 0, -1}, {0, -1, 0}, "water"), wall({4, 1, 1}, {0, -1, 0}, {-1, 0, 0}, "water")}),
        testing::IsEmpty());

    // A cube beside it that shares a face, one with a gap, one that shares a part of the face, one of another material.
    const auto cubeAt = [](vec3 place, const char* material) {
        json shape = mesh("cube.obj"); // from -1 to 1
        shape["material"] = material;
        shape["transform"] = {{{"scale", 0.5}}, {{"translate", {place.x + 0.5f, place.y + 0.5f, place.z + 0.5f}}}};
        return json{shape};
    };
    const auto pairs = [&](vec3 place, const char* material) {
        return loadJson(sceneOfGlass(cube, json::array(), cubeAt(place, material))).touching.size();
    };
    EXPECT_GT(pairs({1, 0, 0}, "water"), 0);
    EXPECT_GT(pairs({1, 0.3f, 0.4f}, "water"), 0);
    EXPECT_EQ(pairs({1.001f, 0, 0}, "water"), 0);
    EXPECT_THAT(saidOfGlass(cube, json::array(), cubeAt({0.5f, 0.5f, 0.5f}, "water")), testing::IsEmpty()) << "overlap";
    EXPECT_EQ(pairs({1, 0, 0}, "grey"), 0);
    json byHand = sceneOfGlass(cube, json::array(), cubeAt({1, 0, 0}, "water"));
    byHand["materials"]["water"]["exteriorIor"] = 1.2;
    EXPECT_THAT(loadJson(byHand).warnings, ElementsAre(HasSubstr("/shapes: a face of glass that has an")));
}

TEST(Scene, MeshNumbersThatNobodyUsesMayBeAnything) {
    const std::string corners =
        "v 0 0 0\nv 1 0 0\nv nan nan -nan(ind)\nv 1 1 0\nv 0 1e39 inf\nvn 0 0 1\nvn nan nan nan\n";
    EXPECT_EQ(loadMeshText(corners + "f 1 2 4\n").triangleCount, 3u);
    EXPECT_EQ(loadMeshText(corners + "f 1//1 2//1 4//1\n").normals.size(), 1u);
    EXPECT_EQ(loadMeshText(corners + "f 1//2 2//2 4//2\n", false).triangleCount, 3u);
    EXPECT_THAT(refusalOfMesh(corners + "f 1//2 2//2 4//2\n"),
                HasSubstr("mesh.obj:7: a normal that a face uses is not finite"));
    EXPECT_THAT(refusalOfMesh(corners + "f 1 2 3\n"), HasSubstr("mesh.obj:3: found \"nan nan -nan(ind)\""));
    EXPECT_THAT(refusalOfMesh(corners + "f 1 2 5\n"), HasSubstr("mesh.obj:5: found \"0 1e39 inf\""));
    EXPECT_THAT(refusalOfMesh("v 0 0 zero\nf 1 1 1\n"), HasSubstr("mesh.obj:1: found \"zero\""));
}

TEST(Scene, FacesOfManyCorners) {
    const int count = 5000;
    std::string text, face = "f";
    for (int i = 0; i < count; i++) { // a comb: every other corner is a reflex one
        const double angle = 2 * std::numbers::pi * i / count, radius = i % 2 ? 1.0 : 0.9;
        text += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    const Scene scene = loadMeshText(text + face);
    EXPECT_EQ(scene.triangleCount, count - 2 + 2u);
    double area = 0;
    for (uint i = 0; i < count - 2; i++)
        area += 0.5 * glm::length(glm::cross(scene.primitives[i].b - scene.primitives[i].a,
                                             scene.primitives[i].c - scene.primitives[i].a));
    EXPECT_NEAR(area, 0.5 * count * 0.9 * std::sin(2 * std::numbers::pi / count), 1e-4);
}

TEST(Scene, OtherFormatsAreRecognised) {
    using namespace std::literals;
    std::string stl(84 + 50, '\0');
    stl[80] = 1;
    const std::pair<std::string, const char*> files[] = {{"solid thing\n facet normal 0 0 1\n", "an STL file"},
                                                         {stl, "an STL file"},
                                                         {"\x1f\x8b\x08\0\0"s, "compressed by gzip"},
                                                         {"BLENDER-v304", "a Blender file"},
                                                         {"Kaydara FBX Binary  \0"s, "an FBX file"},
                                                         {"PK\3\4", "a ZIP archive"}};
    for (const auto& [text, name] : files)
        EXPECT_THAT(refusalOfMesh(text), AllOf(HasSubstr(name), HasSubstr("allowed is an OBJ, PLY or glTF file")))
            << name;
    EXPECT_THAT(refusalOfMesh("ply\n"), HasSubstr("mesh.obj:2: the file ends before its header")); // whatever its name
    EXPECT_THAT(refusalOfMesh("glTF"), HasSubstr("mesh.obj: byte 4: the file ends here"));
}

TEST(Scene, NoPhotonsAreAllowedAsOnTheCommandLine) {
    json scene = smallScene();
    scene["settings"]["photons"] = scene["settings"]["causticPhotons"] = 0;
    EXPECT_EQ(loadJson(scene).settings.photons, 0u);
    EXPECT_EQ(loadJson(scene).settings.causticPhotons, 0u);
}

TEST(Scene, TrianglesWithoutAreaAreDroppedWithAWarning) {
    const Scene scene = loadJson(withShape(mesh("flat_triangle.obj")));
    EXPECT_EQ(scene.triangleCount, 3u); // one of two, and the light's
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("scene.json: /shapes/0: 1 of 2 triangles")));
}

// However weak a light is, random numbers of 24 bits choose it, and its photons weigh what makes up for the
// probability.
TEST(Scene, WeakLightsHaveTheirFlux) {
    for (const double weak : {1e-1, 1e-7, 1e-12}) {
        json scene = smallScene();
        for (const int place : {20, 30, 40}) {
            scene["shapes"].push_back({{"type", "sphere"},
                                       {"center", {place, 0, 0}},
                                       {"radius", 2},
                                       {"emission", place == 30 ? 3.0 : 3 * weak}});
        }
        const Scene lit = loadJson(scene);
        ASSERT_EQ(lit.lights.size(), 4u);
        double total = 0, last = 0;
        for (const Light& light : lit.lights) total += luminance(lightFlux(light));
        for (std::size_t i = 0; i < 4; i++) {
            const double probability = double(lit.lightCdf[i]) - last, steps = std::ldexp(probability, 24);
            last = double(lit.lightCdf[i]);
            EXPECT_GE(steps, 1) << weak;
            EXPECT_EQ(steps, std::round(steps)) << weak;
            const double share = luminance(lightFlux(lit.lights[i])) / total;
            EXPECT_NEAR(double(lit.lights[i].share) * probability, share, 1e-7 * share) << weak << " " << i;
            EXPECT_NEAR(probability, share, 0x1p-22) << weak << " " << i;
        }
        EXPECT_EQ(last, 1);
    }
}

TEST(Scene, CumulativeGivesStepsToAll) {
    std::vector<double> weights(1'000'000, 1e-9);
    weights[500'000] = 1;
    weights[7] = 0;
    const std::vector<float> cdf = cumulative(weights);
    EXPECT_TRUE(std::ranges::is_sorted(cdf));
    EXPECT_EQ(cdf.back(), 1.0f);
    EXPECT_EQ(cdf[7], cdf[6]);
    EXPECT_EQ(std::ranges::count_if(std::views::iota(1u, 1'000'000u), [&](uint i) { return cdf[i] > cdf[i - 1]; }),
              999'998);
    EXPECT_EQ(cumulative(std::vector{0.0, 2.0, 2.0, 0.0}), (std::vector{0.0f, 0.5f, 1.0f, 1.0f}));
}

TEST(Scene, LightsAreChosenByLuminousFlux) {
    json scene = smallScene();
    json sphere{{"type", "sphere"}, {"center", {9, 0, 0}}, {"radius", 2}, {"emission", 3}};
    json cube = mesh("cube.obj");
    cube["emission"] = {0, 1, 0};
    cube["twoSided"] = true;
    scene["shapes"].push_back(sphere);
    scene["shapes"].push_back(cube);
    const Scene lit = loadJson(scene);
    ASSERT_EQ(lit.lights.size(), 14u);
    EXPECT_NE(sceneFeatures(lit, {}).hasManyLights, 0u);

    // Area times luminance times sides: the rectangle, the sphere, and each triangle of the cube of side 2.
    const double weights[] = {4 * (0.2126 + 2 * 0.7152 + 3 * 0.0722), 16 * pi * 3, 2 * 0.7152 * 2};
    const double total = weights[0] + weights[1] + 12 * weights[2];
    float last = 0;
    for (std::size_t i = 0; i < 14; ++i) {
        EXPECT_NEAR(lit.lightCdf[i] - last, weights[std::min<std::size_t>(i, 2)] / total, 1e-6);
        last = lit.lightCdf[i];
    }
    EXPECT_EQ(last, 1.0f);
    EXPECT_NEAR(lit.flux.y, pi * (4 * 2 + 16 * pi * 3 + 24 * 2), 1e-3);
    EXPECT_EQ(lit.lights[1].kind, LIGHT_SPHERE);
    EXPECT_EQ(lit.lights[1].u.x, 2.0f);
    EXPECT_EQ(lit.lights[2].kind, LIGHT_TRIANGLE);
    for (std::size_t i = 0; i < lit.triangleCount; ++i) {
        const Primitive& p = lit.primitives[i];
        if (p.light == NONE || lit.lights[p.light].kind != LIGHT_TRIANGLE) continue;
        EXPECT_EQ(lit.lights[p.light].a + lit.lights[p.light].u, p.b);
    }
}

TEST(Scene, FeaturesAreWhatShapesUse) {
    const Scene plain = loadJson(smallScene()); // mirror and glass are declared, but no shape has them
    Features features = sceneFeatures(plain, plain.settings);
    EXPECT_EQ(features.hasTriangles, 1u);
    EXPECT_EQ(features.hasSpheres, 1u);
    EXPECT_EQ(features.materialKinds, 1u << MATERIAL_DIFFUSE);
    EXPECT_EQ(features.hasSmoothNormals, 0u);
    EXPECT_EQ(features.hasManyLights, 0u);
    EXPECT_EQ(features.hasExactFresnel, 0u);
    EXPECT_EQ(features.hasSchlickFresnel, 0u); // no glass
    EXPECT_EQ(features.hasCausticMap, 0u);
    EXPECT_EQ(features.hasGlobalMap, 1u);
    EXPECT_EQ(features.lightKinds, 1u << LIGHT_RECTANGLE);
    EXPECT_EQ(features.hasTwoSidedLights, 0u);
    EXPECT_EQ(features.hasNearest, 1u);
    EXPECT_EQ(features.densityKernel, DENSITY_KERNEL_CONE);
    EXPECT_EQ(features.stackSize, plain.stackSize);
    EXPECT_TRUE(plain.targets.empty());

    json specular = smallScene();
    specular["shapes"][0]["material"] = "water";
    features = sceneFeatures(loadJson(specular), Settings{});
    EXPECT_EQ(features.materialKinds, 1u << MATERIAL_DIFFUSE | 1u << MATERIAL_GLASS);
    EXPECT_EQ(features.hasExactFresnel, 1u);
    EXPECT_EQ(features.hasSchlickFresnel, 0u);
    EXPECT_EQ(features.hasCausticMap, 1u);
}

// A block of glass above, on and below the floor's height, beside the floor, and one of spheres.
TEST(Scene, GlassThatMayTouchOpaqueFacesIsFound) {
    writeScene("v 0 0 0\nv .1 0 0\nv 0 0 .1\nv 0 .1 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n", "block.obj");
    const auto contact = [](double height, double aside, double far) {
        json scene = smallScene();
        scene["shapes"][0] = {{"type", "mesh"},
                              {"file", "block.obj"},
                              {"material", "water"},
                              {"transform", {{{"translate", {aside, height, 0}}}}}};
        scene["shapes"].push_back(
            {{"type", "rectangle"}, {"corner", {-1, 0, 1}}, {"edges", {{2, 0, 0}, {0, 0, -2}}}, {"material", "grey"}});
        if (far > 0)
            scene["shapes"].push_back(
                {{"type", "sphere"}, {"center", {0, far, 0}}, {"radius", far / 100}, {"emission", 1}});
        const Scene loaded = loadJson(scene);
        return sceneFeatures(loaded, loaded.settings).hasContact;
    };
    for (const double far : {0.0, 1e6}) {
        EXPECT_EQ(contact(0, 0, far), 1u);
        EXPECT_EQ(contact(1e-6, 0, far), 1u);
        EXPECT_EQ(contact(-1e-6, 0, far), 1u);
        EXPECT_EQ(contact(0.01, 0, far), 0u);
        EXPECT_EQ(contact(0, 1.01, far), 0u);
    }
    EXPECT_EQ(sceneFeatures(loadJson(smallScene()), Settings{}).hasContact, 0u); // no glass
}

TEST(Scene, PinholeCameraSpansTheFieldOfView) {
    const View view{{1, 2, 3}, {1, 2, -7}, {0.3f, 5, 9}, pi / 2};
    const Camera camera = pinholeCamera(view, {300, 100});
    expectNear(camera.forward, {0, 0, -1});
    EXPECT_NEAR(glm::length(camera.up), 1, 1e-6);
    EXPECT_NEAR(glm::length(camera.right), 3, 1e-6);
    EXPECT_NEAR(glm::dot(camera.up, camera.right), 0, 1e-6);
    EXPECT_GT(camera.up.y, 0.9f);
    EXPECT_GT(camera.right.x, 0.0f);
}

TEST(BoundingSphere, HoldsAllPointsAndIsSmall) {
    std::mt19937 random{1};
    std::normal_distribution<float> normal;
    for (const float scale : {1e-9f, 1.0f, 1e9f}) {
        std::vector<vec3> points;
        for (int i = 0; i < 5000; ++i)
            points.push_back(scale *
                             (vec3{5, 0, -3} + glm::normalize(vec3{normal(random), normal(random), normal(random)})));
        const Target sphere = boundingSphere(points);
        for (const vec3 point : points) ASSERT_LE(glm::distance(point, sphere.center), sphere.radius);
        EXPECT_LT(sphere.radius, 1.03f * scale);
    }
    const std::vector<vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_NEAR(boundingSphere(square).radius, std::sqrt(0.5f), 1e-5f);
}

} // namespace
} // namespace vkpm
