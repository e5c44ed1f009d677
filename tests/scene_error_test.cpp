/// What the scene loader refuses: each message names file and place, and the JSON Schema agrees wherever it can tell.
// GCC 12 with sanitizers mistakes the insides of std::regex, which valijson uses, for uninitialized.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include "gltf_text.h"
#include "scene/reader.h"
#include "scene/text.h"
#include "scene_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <memory>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace vkpm {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

json readJson(const fs::path& file) { return parseJson(file, readText(file, maxSceneBytes, "")); }

/// Whether the shipped schema accepts a scene.
bool schemaAccepts(const json& scene) {
    static const auto schema = [] {
        const json source = readJson(fs::path{VKPM_SCENES} / "scene.schema.json");
        auto parsed = std::make_unique<valijson::Schema>();
        valijson::SchemaParser{}.populateSchema(valijson::adapters::NlohmannJsonAdapter{source}, *parsed);
        return parsed;
    }();
    return valijson::Validator{}.validate(*schema, valijson::adapters::NlohmannJsonAdapter{scene}, nullptr);
}

enum class Schema { notJson, accepts, refuses };

/// A file of data/invalid, where it is wrong and how; and whether the schema can tell.
struct Invalid {
    const char* name;
    const char* place;
    const char* message;
    Schema schema = Schema::notJson;
};

const Invalid invalid[] = {
    {"unknown_key", ": /shapes/0/radus: ", "did you mean \"radius\"?", Schema::refuses},
    {"misspelt_required_key", ": /camera/traget: ", "did you mean \"target\"?", Schema::refuses},
    {"unknown_section", ": /lamps: ", "unknown key", Schema::refuses},
    {"no_camera", ": /: ", "\"camera\" is missing", Schema::refuses},
    {"no_shapes", ": /: ", "\"shapes\" is missing", Schema::refuses},
    {"empty_shapes", ": /shapes: ", "at least one", Schema::refuses},
    {"not_an_object", ": /: ", "allowed is an object", Schema::refuses},
    {"wrong_type", ": /camera/origin: ", "found \"here\"; allowed is an array of 3", Schema::refuses},
    {"two_coordinates", ": /camera/origin: ", "array of 2", Schema::refuses},
    {"negative_radius", ": /shapes/0/radius: ", "found -1; allowed is a finite number > 0", Schema::refuses},
    {"zero_radius", ": /shapes/0/radius: ", "found 0", Schema::refuses},
    {"beyond_float", ": /shapes/0/center/1: ", "32-bit float", Schema::refuses},
    {"albedo_above_one", ": /materials/grey/albedo/1: ", "allowed is a number >= 0 and <= 1", Schema::refuses},
    {"negative_reflectance", ": /materials/grey/reflectance: ", "found -0.1", Schema::refuses},
    {"tint_above_one", ": /materials/grey/tint: ", "found 2", Schema::refuses},
    {"zero_ior", ": /materials/grey/ior: ", "found 0", Schema::refuses},
    {"extreme_ior", ": /materials/grey/ior: ", "ratio", Schema::accepts},
    {"unknown_material_type", ": /materials/grey/type: ", "did you mean \"glass\"?", Schema::refuses},
    {"glass_with_albedo", ": /materials/grey/albedo: ", "unknown key", Schema::refuses},
    {"roughness_above_one", ": /materials/grey/roughness: ", "found 2", Schema::refuses},
    {"misspelt_roughness", ": /materials/grey/roughnes: ", "did you mean \"roughness\"?", Schema::refuses},
    {"metal_of_nothing", ": /materials/grey: ", "\"reflectance\" is missing", Schema::refuses},
    {"metal_given_twice", ": /materials/grey/preset: ", "found both", Schema::refuses},
    {"unknown_metal", ": /materials/grey/preset: ", "did you mean \"silver\"?", Schema::refuses},
    {"coat_of_nothing", ": /materials/grey/ior: ", "found 0.9", Schema::refuses},
    {"unknown_material", ": /shapes/0/material: ", "did you mean \"grey\"? known: \"grey\"", Schema::accepts},
    {"no_material", ": /shapes/0: ", "\"material\" is missing", Schema::refuses},
    {"negative_emission", ": /shapes/1/emission/1: ", "found -1", Schema::refuses},
    {"no_light", ": /shapes: ", "there is no light", Schema::accepts},
    {"black_light", ": /shapes: ", "there is no light", Schema::accepts},
    {"missing_mesh", ": /shapes/0/file: ", "does not exist", Schema::accepts},
    {"mesh_is_a_folder", ": /shapes/0/file: ", "a folder", Schema::accepts},
    {"camera_at_its_target", ": /camera/target: ", "the target is the origin", Schema::accepts},
    {"up_along_the_view", ": /camera/up: ", "along the view", Schema::accepts},
    {"wide_field_of_view", ": /camera/fieldOfView: ", "found 180", Schema::refuses},
    {"singular_transform", ": /shapes/0/transform: ", "singular", Schema::accepts},
    {"scale_by_zero", ": /shapes/0/transform/0/scale: ", "factor of 0", Schema::refuses},
    {"stretched_sphere", ": /shapes/0/transform: ", "use a mesh instead", Schema::accepts},
    {"two_steps_in_one", ": /shapes/0/transform/0: ", "a step has one of", Schema::refuses},
    {"projective_matrix", ": /shapes/0/transform/0/matrix: ", "affine", Schema::accepts},
    {"rotation_about_nothing", ": /shapes/0/transform/0/rotate/axis: ", "length 0", Schema::accepts},
    {"degenerate_rectangle", ": /shapes/1/edges: ", "no area", Schema::accepts},
    {"film_without_height", ": /film/size: ", "array of 1", Schema::refuses},
    {"film_too_wide", ": /film/size/0: ", "from 1 to 65536", Schema::refuses},
    {"film_too_large", ": /film/size: ", "2^28", Schema::accepts},
    {"half_a_pixel", ": /film/size/0: ", "found 64.5", Schema::refuses},
    {"no_passes", ": /settings/passes: ", "found 0", Schema::refuses},
    {"unknown_kernel", ": /settings/kernel: ", "did you mean \"gauss\"?", Schema::refuses},
    {"huge_scene", ": /shapes: ", "at most 1e12", Schema::accepts},
    {"unknown_shape", ": /shapes/0/type: ", "found \"cube\"; allowed is \"sphere\", \"rectangle\" or \"mesh\"",
     Schema::refuses},
    {"empty", ":1:1: ", "the file is empty"},
    {"blank", ":1:1: ", "the file is empty"},
    {"syntax", ":2:14: ", "syntax error"},
    {"cut_off", ":1:101: ", "missing closing quote"},
    {"trailing_comma", ":2:1: ", "syntax error"},
    {"text_after_the_end", ":2:1: ", "syntax error"},
    {"not_a_number", ":1:12: ", "invalid literal"},
    {"number_overflow", ":2:7: ", "1e400"},
    {"not_utf8", ":1:12: ", "UTF-8"},
    {"duplicate_key", ": /camera/origin: ", "given twice"},
    {"deeply_nested", ": /shapes/0/0/0", "nested deeper than 64"},
};

TEST(SceneErrors, NameFileAndPlace) {
    std::set<fs::path> tested;
    for (const Invalid& entry : invalid) {
        const fs::path file = fs::path{VKPM_TEST_DATA} / "invalid" / (std::string{entry.name} + ".json");
        const std::string error = errorOf(file);
        EXPECT_EQ(error.find(file.string() + entry.place), 0u) << entry.name << ": " << error;
        EXPECT_THAT(error, HasSubstr(entry.message)) << entry.name;
        EXPECT_THAT(error, HasSubstr("; ")) << entry.name;
        tested.insert(file);
        if (entry.schema == Schema::notJson) continue;
        EXPECT_EQ(schemaAccepts(readJson(file)), entry.schema == Schema::accepts) << entry.name;
    }
    for (const auto& entry : fs::directory_iterator{fs::path{VKPM_TEST_DATA} / "invalid"})
        EXPECT_TRUE(tested.contains(entry.path())) << entry.path();
}

TEST(SceneErrors, NameWhatIsNotAFile) {
    EXPECT_THAT(errorOf(fs::path{VKPM_TEST_DATA} / "none.json"), HasSubstr("none.json: the file does not exist"));
    EXPECT_THAT(errorOf(fs::path{VKPM_TEST_DATA}), HasSubstr("this is a folder"));
}

TEST(SceneErrors, NameTheLineOfAMesh) {
    const std::pair<const char*, const char*> meshes[] = {
        {"index_out_of_range", ".obj:4: a face refers to vertex 4; the file has 3"},
        {"index_before_the_first", ".obj:4: found \"-4\""},
        {"index_zero", ".obj:4: found \"0\""},
        {"nan_vertex", ".obj:2: found \"nan 0 0\" as coordinates of a vertex that a face uses"},
        {"infinite_vertex", ".obj:3: found \"0 1 1e39\""},
        {"two_coordinates", ".obj:1: found \"\""},
        {"normal_out_of_range", ".obj:5: a face refers to normal 2; the file has 1"},
        {"two_corners", ".obj:3: the mesh has no faces"},
        {"no_faces", ".obj:3: the mesh has no faces"},
        {"empty", ".obj:1: the mesh has no faces"},
        {"not_an_obj", ".obj:1: found a byte 0"},
        {"no_area", "scene.json: /shapes/0/file: no triangle of the mesh has an area"},
    };
    for (const auto& [name, message] : meshes) {
        const fs::path file = fs::path{VKPM_TEST_DATA} / "meshes" / (std::string{name} + ".obj");
        json scene = smallScene();
        scene["shapes"][0] = {{"type", "mesh"}, {"file", file.string()}, {"material", "grey"}};
        EXPECT_THAT(errorOf(scene), HasSubstr(message)) << name;
    }
}

TEST(SceneErrors, NearestWordIsNearOrNone) {
    EXPECT_EQ(nearestWord("emision", {"emission", "edges"}), "emission");
    EXPECT_EQ(nearestWord("Emission", {"emission", "edges"}), "emission");
    EXPECT_EQ(nearestWord("xyzzy", {"emission", "edges"}), "");
    EXPECT_EQ(nearestWord("", {"up"}), "");
}

TEST(Schema, AcceptsShippedScenes) {
    for (const auto& entry : fs::directory_iterator{VKPM_SCENES}) {
        if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
        EXPECT_TRUE(schemaAccepts(readJson(entry.path()))) << entry.path();
    }
}

/// Pointers to every value of a scene.
std::vector<json::json_pointer> places(const json& value, const json::json_pointer& here = json::json_pointer{}) {
    std::vector<json::json_pointer> all{here};
    for (const auto& [key, member] : value.items()) {
        if (!value.is_structured()) break;
        const json::json_pointer there =
            value.is_array() ? here / static_cast<std::size_t>(std::stoul(key)) : here / key;
        for (const json::json_pointer& place : places(member, there)) all.push_back(place);
    }
    return all;
}

/// Refusals that no schema can express.
const auto beyondSchema =
    AnyOf(HasSubstr("no light"), HasSubstr("unknown material"), HasSubstr("does not exist"), HasSubstr("a folder"),
          HasSubstr("no area"), HasSubstr("along the view"), HasSubstr("is the origin"), HasSubstr("singular"),
          HasSubstr("length 0"), HasSubstr("allowed is a .gltf or .glb file"), HasSubstr("affine"),
          HasSubstr("non-uniform"), HasSubstr("at most 1e12"));

/// The schema must refuse nothing that the loader takes; what it takes the loader may refuse for reasons of its own.
void expectAgreement(const json& scene, const std::string& what) {
    const std::string error = errorOf(scene);
    if (schemaAccepts(scene)) {
        EXPECT_THAT(error, AnyOf("", beyondSchema)) << what;
    } else {
        EXPECT_NE(error, "") << what;
    }
    EXPECT_THAT(error, AnyOf("", HasSubstr("scene.json: /"))) << what;
}

// Every key of "import" against every kind of value.
TEST(Schema, AgreesWithTheLoaderAboutImports) {
    writeScene(squareModel().glb(), "model.glb");
    json scene = smallScene();
    scene["import"] = json::parse(
        R"({"file": "model.glb", "transform": [{"scale": 2}], "lights": "raw", "lampRadius": 0.1, "glass": "thin"})");
    expectAgreement(scene, "import");
    EXPECT_EQ(errorOf(scene), "");
    for (const char* key : {"file", "transform", "lights", "lampRadius", "glass", "surplus"})
        for (const json& value : {json(nullptr), json(0), json(1), json(-1), json("x"), json("auto"), json("standard"),
                                  json::array(), json::object()}) {
            json changed = scene;
            changed["import"][key] = value;
            expectAgreement(changed, key + (" = " + value.dump()));
        }
    for (const char* key : {"camera", "shapes", "import"}) {
        json changed = scene;
        changed.erase(key);
        EXPECT_EQ(errorOf(changed), "") << key;
        EXPECT_TRUE(schemaAccepts(changed)) << key;
    }
}

TEST(Schema, AgreesWithTheLoaderAboutEveryValue) {
    const json values[] = {nullptr,
                           true,
                           "",
                           "x",
                           0,
                           -1,
                           0.5,
                           3,
                           1e39,
                           -1e39,
                           json::array(),
                           {1, 2},
                           {1, 2, 3},
                           {1, 2, 3, 4},
                           {1, "x", 3},
                           json::object(),
                           {{"type", "sphere"}}};
    for (const json::json_pointer& place : places(smallScene()))
        for (const json& value : values) {
            json scene = smallScene();
            scene[place] = value;
            expectAgreement(scene, place.to_string() + " = " + value.dump());
        }
}

TEST(Schema, HasTheRangesOfTheLoader) {
    const json schema = readJson(fs::path{VKPM_SCENES} / "scene.schema.json");
    int ends = 0;
    for (const char* section : {"camera", "film", "settings"})
        for (const auto& [key, rule] : schema["properties"][section]["properties"].items())
            for (const char* end : {"minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"}) {
                if (!rule.contains(end)) continue;
                const bool isInteger = rule["type"] == "integer";
                for (const double step : {-1.0, 0.0, 1.0}) {
                    const double value = rule[end].get<double>() + (isInteger ? step : 1e-3 * step);
                    json scene = smallScene();
                    scene[section][key] = isInteger ? json(static_cast<std::int64_t>(value)) : json(value);
                    expectAgreement(scene, key + " = " + scene[section][key].dump());
                }
                ends++;
            }
    EXPECT_GE(ends, 16);
}

TEST(Schema, HasTheNamesAndDefaultsOfTheSettings) {
    const json rules = readJson(fs::path{VKPM_SCENES} / "scene.schema.json")["properties"]["settings"]["properties"];
    EXPECT_EQ(rules["kernel"]["enum"], json(kernelNames));
    EXPECT_EQ(rules["fresnel"]["enum"], json(fresnelNames));
    EXPECT_EQ(rules["layers"]["items"]["enum"], json(layerNames));
    EXPECT_EQ(rules["layers"]["maxItems"], layerNames.size());

    const Settings defaults;
    EXPECT_EQ(rules["passes"]["default"], defaults.passes);
    EXPECT_EQ(rules["photons"]["default"], defaults.photons);
    EXPECT_EQ(rules["causticPhotons"]["default"], defaults.causticPhotons);
    EXPECT_EQ(rules["pixelSamples"]["default"], defaults.pixelSamples);
    EXPECT_EQ(rules["pixelSamples"]["maximum"], maxPixelSamples);
    EXPECT_EQ(rules["gatherRays"]["default"], defaults.gatherRays);
    EXPECT_EQ(rules["gatherRays"]["maximum"], maxGatherRays);
    EXPECT_EQ(rules["nearest"]["default"], defaults.nearest);
    EXPECT_EQ(rules["alpha"]["default"].get<float>(), defaults.alpha);
    EXPECT_EQ(rules["kernel"]["default"], kernelNames[defaults.kernel]);
    EXPECT_EQ(rules["fresnel"]["default"], fresnelNames[defaults.schlick]);
    EXPECT_EQ(rules["seed"]["default"], defaults.seed);
}

TEST(Schema, AgreesWithTheLoaderAboutEveryKey) {
    for (const json::json_pointer& place : places(smallScene())) {
        json scene = smallScene();
        if (scene[place].is_object()) {
            scene[place]["surplus"] = 1;
            expectAgreement(scene, "surplus in " + place.to_string());
        }
        if (place.empty()) continue;
        scene = smallScene();
        json& parent = scene[place.parent_pointer()];
        if (parent.is_object()) parent.erase(place.back());
        else parent.erase(static_cast<std::size_t>(std::stoul(place.back())));
        expectAgreement(scene, "without " + place.to_string());
    }
}

} // namespace
} // namespace vkpm
