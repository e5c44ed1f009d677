/// Normal maps: normals by hand, furnaces that lose nothing, and photons that see what paths from the eye see.
#include "draw.h"
#include "gltf_text.h"
#include "images.h"
#include "render_support.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace vkpm {
namespace {

using nlohmann::json;

/// Facets of all directions: the tangents of their tilts are normal, of a deviation.
void writeFacets(const std::string& name, double deviation) {
    std::mt19937 random(1);
    std::normal_distribution<double> tangent(0, deviation);
    std::vector<unsigned char> texels;
    for (int i = 0; i < 32 * 32; i++) {
        const glm::dvec3 n = glm::normalize(glm::dvec3{tangent(random), tangent(random), 1});
        for (int c = 0; c < 3; c++) texels.push_back(static_cast<unsigned char>(std::lround((n[c] + 1) / 2 * 255)));
        texels.push_back(255);
    }
    writeScene(pngBytes(32, 32, texels), name);
}

json lookingDown(const json& normalMap, const json& shape) {
    json scene = {{"camera", {{"origin", {0, 0, 4}}, {"target", {0, 0, 0}}, {"fieldOfView", 1}}},
                  {"film", {{"size", {1, 1}}}},
                  {"environment", {{"radiance", 1}}},
                  {"materials", {{"m", {{"type", "diffuse"}, {"albedo", 1}, {"normalMap", normalMap}}}}},
                  {"shapes", {shape}}};
    scene["shapes"][0]["material"] = "m";
    return scene;
}

vec3 normalSeen(const json& scene) {
    return renderPasses(loadJson(scene), loadJson(scene).settings, 1).pixels[0].mean.normal;
}

void expectNear(vec3 found, glm::dvec3 expected, const char* what) {
    for (int c = 0; c < 3; c++) EXPECT_NEAR(double{found[c]}, glm::normalize(expected)[c], 2e-3) << what << " " << c;
}

// Red turns it along u, green along v, which goes up; as bytes say: 2 c / 255 - 1.
TEST(NormalMaps, TurnNormalsAlongTheTexture) {
    const json shape = {{"type", "rectangle"}, {"corner", {-1, -1, 0}}, {"edges", {{2, 0, 0}, {0, 2, 0}}}};
    const glm::dvec3 value{204 / 127.5 - 1, 153 / 127.5 - 1, 230 / 127.5 - 1};
    writeScene(pngBytes<unsigned char>(1, 1, {204, 153, 230, 255}), "tilt.png");
    writeScene(pngBytes<unsigned char>(1, 1, {128, 128, 255, 255}), "flat.png");
    const json tilt = {{"texture", "tilt.png"}};
    expectNear(normalSeen(lookingDown(tilt, shape)), value, "rectangle");
    json weak = tilt;
    weak["strength"] = 0.5;
    expectNear(normalSeen(lookingDown(weak, shape)), value * glm::dvec3{0.5, 0.5, 1}, "strength");
    const double tilted = glm::length(glm::dvec2{normalSeen(lookingDown({{"texture", "flat.png"}}, shape))});
    EXPECT_NEAR(glm::degrees(std::asin(tilted)), 0.3183, 1e-3); // sqrt(2) / 255

    json turned = shape; // u to -y, v to x
    turned["corner"] = {-1, 1, 0};
    turned["edges"] = {{0, -2, 0}, {2, 0, 0}};
    expectNear(normalSeen(lookingDown(tilt, turned)), {value.y, -value.x, value.z}, "turned");
    const json ball = {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}};
    json near = lookingDown(tilt, ball);
    near["camera"]["fieldOfView"] = 0.01;
    expectNear(normalSeen(near), value, "sphere");
}

// Coordinates that are mirrored turn along themselves; where they span no area, nothing is turned, which is said.
TEST(NormalMaps, FollowTheCoordinatesOfMeshes) {
    writeScene(pngBytes<unsigned char>(1, 1, {204, 153, 230, 255}), "tilt.png");
    const glm::dvec3 value{204 / 127.5 - 1, 153 / 127.5 - 1, 230 / 127.5 - 1};
    const auto mesh = [&](const std::string& places) {
        writeScene("v -1 -1 0\nv 3 -1 0\nv -1 3 0\n" + places + "f 1/1 2/2 3/3\n", "mesh.obj");
        return lookingDown({{"texture", "tilt.png"}}, {{"type", "mesh"}, {"file", "mesh.obj"}});
    };
    expectNear(normalSeen(mesh("vt 0 0\nvt 2 0\nvt 0 2\n")), value, "as they are");
    expectNear(normalSeen(mesh("vt 0 0\nvt -2 0\nvt 0 2\n")), value * glm::dvec3{-1, 1, 1}, "mirrored");
    const json flat = mesh("vt 0 0\nvt 2 0\nvt 1 0\n");
    expectNear(normalSeen(flat), {0, 0, 1}, "without an area");
    EXPECT_THAT(loadJson(flat).warnings, testing::ElementsAre(testing::HasSubstr("span no area")));
}

// A mesh's own tangents count in place of its coordinates, mirrored ones too, where it has normals.
TEST(NormalMaps, FollowTheTangentsOfMeshes) {
    writeScene(pngBytes<unsigned char>(1, 1, {204, 153, 230, 255}), "tilt.png");
    const glm::dvec3 value{204 / 127.5 - 1, 153 / 127.5 - 1, 230 / 127.5 - 1};
    const auto seen = [&](float side, const json& node, bool hasNormals = true, bool hasTangents = true) {
        GltfText model;
        json attributes = {{"POSITION", model.add<float>({-1, -1, 0, 3, -1, 0, -1, 3, 0}, "VEC3")},
                           {"TEXCOORD_0", model.add<float>({0, 1, 2, 1, 0, -1}, "VEC2")}};
        if (hasNormals) attributes["NORMAL"] = model.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        if (hasTangents)
            attributes["TANGENT"] = model.add<float>({0, 1, 0, side, 0, 1, 0, side, 0, 1, 0, side}, "VEC4");
        model.json["meshes"] = {{{"primitives", {{{"attributes", attributes}}}}}};
        model.json["nodes"] = {node};
        writeScene(model.glb(), "model.glb");
        return normalSeen(lookingDown({{"texture", "tilt.png"}}, {{"type", "mesh"}, {"file", "model.glb"}}));
    };
    const json as = {{"mesh", 0}}, mirrored = {{"mesh", 0}, {"scale", {-1, 1, 1}}};
    const glm::dvec3 turned{-value.y, value.x, value.z}, other{value.y, value.x, value.z};
    expectNear(seen(1, as, true, false), value, "coordinates");
    expectNear(seen(1, as), turned, "tangents");
    expectNear(seen(-1, as), other, "of another side");
    expectNear(seen(1, mirrored), other, "mirrored");
    expectNear(seen(-1, mirrored), turned, "of another side, mirrored");
    expectNear(seen(1, as, false), value, "without normals");
}

// A white ball of strong facets vanishes before a white sky.
TEST(NormalMaps, LoseNothing) {
    SKIP_UNLESS_DRAWN(0);
    writeFacets("strong.png", 1);
    for (const json& material :
         {json{{"type", "diffuse"}, {"albedo", 1}}, json{{"type", "plastic"}, {"albedo", 1}, {"roughness", 0.3}},
          json{{"type", "metal"}, {"reflectance", 1}, {"roughness", 0.8}}, json{{"type", "metal"}, {"reflectance", 1}},
          json{{"type", "glass"}, {"ior", 1.5}}}) {
        json scene = lookingDown({{"texture", "strong.png"}, {"filter", "nearest"}},
                                 {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}});
        const json map = scene["materials"]["m"]["normalMap"];
        scene["materials"]["m"] = material;
        scene["materials"]["m"]["normalMap"] = map;
        scene["camera"]["fieldOfView"] = 18; // the square lies within the ball
        scene["film"]["size"] = {16, 16};
        const Scene ball = loadJson(scene);
        for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH}) {
            Settings settings = ball.settings;
            settings.integrator = integrator;
            const Rendered image = renderPasses(ball, settings, 48);
            std::vector<double> means;
            for (int part = 0; part < 16; part++) {
                const auto first = image.pixels.begin() + 16 * part;
                means.push_back(layerMean({first, first + 16}, LAYER_COUNT));
            }
            const Estimate found = estimate(means);
            EXPECT_NEAR(found.mean, 1, 4 * found.error + 2e-3) << material << integrator;
            EXPECT_LT(found.error, 0.01) << material << integrator;
        }
    }
}

// Water with waves on a floor with bumps, a ball of brass in it: layers by photons, by paths, caustics by light
// tracing.
TEST(NormalMaps, PhotonsSeeWhatPathsSee) {
    SKIP_UNLESS_DRAWN(1);
    writeFacets("waves.png", 0.4);
    const json map = {{"texture", "waves.png"}};
    const auto wall = [](vec3 corner, vec3 u, vec3 v, const char* material) {
        const auto list = [](vec3 x) { return json{x.x, x.y, x.z}; };
        return json{
            {"type", "rectangle"}, {"corner", list(corner)}, {"edges", {list(u), list(v)}}, {"material", material}};
    };
    json lamp = wall({-1.49f, 0.6f, -0.4f}, {0, 0.4f, 0}, {0, 0, 0.8f}, "white");
    lamp["emission"] = {8, 7, 6}; // over the water, where it matters most that scattering is the same both ways
    const Scene scene = loadJson(
        {{"camera", {{"origin", {0, 1.6, 3.4}}, {"target", {0, 0.6, 0}}, {"fieldOfView", 40}}},
         {"film", {{"size", {32, 24}}}},
         {"settings", {{"photons", 20000}, {"causticPhotons", 20000}, {"radius", 0.015}, {"causticRadius", 0.015}}},
         {"materials",
          {{"white", {{"type", "diffuse"}, {"albedo", 0.7}}},
           {"floor", {{"type", "plastic"}, {"albedo", {0.6, 0.5, 0.4}}, {"roughness", 0.7}, {"normalMap", map}}},
           {"back", {{"type", "diffuse"}, {"albedo", 0.7}, {"normalMap", map}}},
           {"brass", {{"type", "metal"}, {"preset", "gold"}, {"roughness", 0.3}, {"normalMap", map}}},
           {"water", {{"type", "glass"}, {"ior", 1.33}, {"normalMap", map}}}}},
         {"shapes",
          {wall({-1.5f, 0, 1.5f}, {3, 0, 0}, {0, 0, -3}, "floor"),
           wall({-1.5f, 0, -1.5f}, {3, 0, 0}, {0, 2.2f, 0}, "back"),
           wall({-1.5f, 0, 1.5f}, {0, 0, -3}, {0, 2.2f, 0}, "white"),
           wall({1.5f, 0, -1.5f}, {0, 0, 3}, {0, 2.2f, 0}, "white"),
           wall({-1.5f, 2.2f, -1.5f}, {3, 0, 0}, {0, 0, 3}, "white"),
           lamp,
           wall({-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, "water"),
           wall({-1, 0.3f, -1}, {2, 0, 0}, {0, 0, 2}, "water"),
           wall({-1, 0.3f, 1}, {2, 0, 0}, {0, 0.2f, 0}, "water"),
           wall({1, 0.3f, -1}, {-2, 0, 0}, {0, 0.2f, 0}, "water"),
           wall({-1, 0.3f, -1}, {0, 0, 2}, {0, 0.2f, 0}, "water"),
           wall({1, 0.3f, 1}, {0, 0, -2}, {0, 0.2f, 0}, "water"),
           {{"type", "sphere"}, {"center", {0.2, 0.9, -0.6}}, {"radius", 0.35}, {"material", "brass"}}}}});
    const auto means = [&](uint integrator, uint passes) {
        Settings settings = scene.settings;
        settings.integrator = integrator;
        std::vector<std::vector<double>> layers(LAYER_COUNT);
        for (settings.seed = 1; settings.seed <= 6; settings.seed++) {
            const Rendered image = renderPasses(scene, settings, passes);
            EXPECT_EQ(image.nonfinite, 0u);
            for (uint layer = 0; layer < LAYER_COUNT; layer++) layers[layer].push_back(layerMean(image.pixels, layer));
        }
        std::vector<Estimate> result;
        for (const auto& list : layers) result.push_back(estimate(list));
        return result;
    };
    const auto photon = means(INTEGRATOR_PHOTON, 16), path = means(INTEGRATOR_PATH, 96);
    const auto expectSame = [](Estimate a, Estimate b, double noise, double bias, const std::string& what) {
        const double allowed = 4 * std::hypot(a.error, b.error);
        std::printf("%s %.6f +- %.6f, %.6f +- %.6f\n", what.c_str(), a.mean, a.error, b.mean, b.error);
        EXPECT_NEAR(a.mean, b.mean, allowed + bias * b.mean) << what;
        EXPECT_LE(allowed, noise * b.mean) << what;
    };
    expectSame(photon[LAYER_DIRECT], path[LAYER_DIRECT], 0.01, 0.003, "direct");
    expectSame(photon[LAYER_SPECULAR], path[LAYER_SPECULAR], 0.2, 0.003, "specular");
    expectSame(photon[LAYER_CAUSTIC], path[LAYER_CAUSTIC], 0.1, 0.012, "caustic");
    expectSame(photon[LAYER_INDIRECT], path[LAYER_INDIRECT], 0.06, 0.012, "indirect");
    expectSame(means(INTEGRATOR_LIGHT, 24)[LAYER_CAUSTIC], path[LAYER_CAUSTIC], 0.07, 0.003,
               "caustic by light tracing");
}

TEST(NormalMaps, AreRefusedWhereTheyMakeNoSense) {
    writeScene(greyPng(128), "grey.png");
    json scene = smallScene();
    const auto problem = [&](const char* material, const json& map) {
        json changed = scene;
        changed["materials"][material]["normalMap"] = map;
        return errorOf(changed);
    };
    EXPECT_EQ(problem("grey", {{"texture", "grey.png"}, {"strength", 2}}), "");
    EXPECT_THAT(problem("steel", {{"texture", "grey.png"}}),
                testing::HasSubstr("/materials/steel/normalMap: unknown key"));
    EXPECT_THAT(problem("grey", {{"texture", "grey.png"}, {"factor", 2}}),
                testing::HasSubstr("normalMap/factor: unknown key"));
    EXPECT_THAT(problem("grey", {{"texture", "grey.png"}, {"strength", "a"}}),
                testing::HasSubstr("normalMap/strength"));
}

} // namespace
} // namespace vkpm
