/// Skies, suns, points and spots: what they bring, against closed forms, and each layer against the path tracer.
#include "draw.h"
#include "images.h"
#include "judge.h"
#include "output/exr.h"
#include "render_support.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>

namespace vkpm {
namespace {

using glm::dvec3;
using nlohmann::json;
using testing::HasSubstr;

/// A file in Radiance's format without runs; every texel has the exponent of its greatest component.
void writeHdr(const std::string& name, uint width, uint height, const std::function<vec3(uint x, uint y)>& color) {
    std::string bytes =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    for (uint y = 0; y < height; y++)
        for (uint x = 0; x < width; x++) {
            const vec3 c = color(x, y);
            int exponent = 0;
            const float most = std::max({c.x, c.y, c.z});
            if (most > 0) std::frexp(most, &exponent);
            for (int i = 0; i < 3; i++) bytes += char(static_cast<unsigned char>(std::ldexp(c[i], 8 - exponent)));
            bytes += char(most > 0 ? exponent + 128 : 0);
        }
    writeScene(bytes, name);
}

/// A white floor of albedo 1 that fills the picture, seen from above; what lights it is to be added.
json floorScene() {
    return json::parse(R"({
        "camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "up": [0, 0, -1], "fieldOfView": 10},
        "film": {"size": [16, 16]}, "settings": {"photons": 1000, "layers": ["direct"]},
        "materials": {"white": {"type": "diffuse", "albedo": 1}},
        "shapes": [{"type": "rectangle", "corner": [-1, 0, 1], "edges": [[2, 0, 0], [0, 0, -2]], "material": "white"}]})");
}

/// Irradiance of the floor: pi times its radiance, by light samples.
double irradiance(const json& scene, uint passes = 4) {
    const Scene loaded = loadJson(scene);
    const double radiance = layerMean(renderPasses(loaded, loaded.settings, passes).pixels, LAYER_DIRECT);
    return pi * radiance;
}

json sun(const json& direction, double strength, double degrees = 0.53) {
    return {{"type", "sun"}, {"direction", direction}, {"irradiance", strength}, {"angle", degrees}};
}

TEST(Lamps, IrradianceIsThatOfTheirNumbers) {
    json scene = floorScene();
    const auto with = [&](const json& lamp) {
        scene["lights"] = {lamp};
        return irradiance(scene);
    };
    EXPECT_NEAR(with(sun({0, 1, 0}, 1)), 1, 1e-4);
    EXPECT_NEAR(with(sun({0.6, 0.8, 0}, 1)), 0.8, 1e-4);
    EXPECT_NEAR(with(sun({0, 1, 0}, 1, 0.001)), 1, 1e-4);
    EXPECT_NEAR(with(sun({0, 1, 0}, 1, 180)), 1, 2e-2); // half the sky
    // The floor is 0.0872 high and wide where the camera sees it: 1 + 0.0872^2 / 6 away in the mean.
    const double intensity = 10 / (4 * pi);
    EXPECT_NEAR(with({{"type", "point"}, {"position", {0, 2, 0}}, {"intensity", intensity}}), 0.1989, 6e-4);
    EXPECT_NEAR(with({{"type", "point"}, {"position", {0, 2, 0}}, {"intensity", intensity}, {"radius", 0.05}}), 0.1989,
                2e-3);
    json spot{{"type", "spot"},          {"position", {0, 2, 0}}, {"intensity", intensity},
              {"direction", {0, -1, 0}}, {"inner", 20},           {"outer", 40}};
    EXPECT_NEAR(with(spot), 0.1989, 6e-4);
    // Half way between the cones in the cosine: a quarter; beyond the outer one nothing.
    for (const auto& [cosine, part] :
         {std::pair(0.5 * (std::cos(20 * pi / 180) + std::cos(40 * pi / 180)), 0.25), {std::cos(41 * pi / 180), 0.0}}) {
        json turned = spot;
        turned["direction"] = {std::sqrt(1 - cosine * cosine), -cosine, 0};
        EXPECT_NEAR(with(turned), part * 0.1989, 1e-3) << part;
        turned["radius"] = 0.02;
        EXPECT_NEAR(with(turned), part * 0.1989, 2e-3) << part;
    }
    spot["radius"] = 0.1;
    EXPECT_NEAR(with(spot), 0.1989, 2e-3);
}

// One texel of 1e6: E = 1e6 2 pi / W (cos t0 - cos t1), at 45 degrees, at the horizon and at the pole; light samples of
// it have no noise.
TEST(Sky, OneTexelIsASun) {
    const uint height = 512, width = 1024;
    for (const auto& [row, expected] : {std::pair(128u, 26.70), {253u, 37.65}, {0u, 0.1155}}) {
        writeHdr("sun.hdr", width, height,
                 [&, r = row](uint x, uint y) { return vec3{x == 300 && y == r ? 1e6f : 0}; });
        json scene = floorScene();
        scene["environment"] = {{"image", "sun.hdr"}};
        const double angle = pi * (row + 0.5) / height, turn = 2 * pi * (300.5 / width - 0.5);
        const dvec3 toSun{std::sin(angle) * std::sin(turn), std::cos(angle), -std::sin(angle) * std::cos(turn)};
        // A floor that faces it.
        const dvec3 u = glm::normalize(glm::cross(toSun, dvec3{0.3, 0.1, 1})), v = glm::cross(toSun, u);
        scene["shapes"][0]["corner"] = {-u.x - v.x, -u.y - v.y, -u.z - v.z};
        scene["shapes"][0]["edges"] = {{2 * u.x, 2 * u.y, 2 * u.z}, {2 * v.x, 2 * v.y, 2 * v.z}};
        scene["camera"]["origin"] = {toSun.x, toSun.y, toSun.z};
        scene["camera"]["up"] = {u.x, u.y, u.z};
        const double found = irradiance(scene, 1);
        const double texel = std::ldexp(std::floor(1e6 / 4096), 12) / 1e6; // eight bits
        EXPECT_NEAR(found / (expected * texel), 1, 5e-4) << row;
        std::printf("one texel in row %u: E %.4f, expected %.4f\n", row, found / texel, expected);
    }
}

/// A ball in a constant sky.
json furnace() {
    return json::parse(R"({
        "camera": {"origin": [0, 0, 5], "target": [0, 0, 0], "fieldOfView": 35},
        "film": {"size": [32, 32]}, "settings": {"photons": 2000, "causticPhotons": 2000},
        "environment": {"radiance": [0.5, 1, 2]},
        "materials": {"diffuse": {"type": "diffuse", "albedo": 1}, "mirror": {"type": "mirror", "reflectance": 1},
                      "glass": {"type": "glass", "ior": 1.5}, "metal": {"type": "metal", "reflectance": 1, "roughness": 0.6},
                      "plastic": {"type": "plastic", "albedo": 1}},
        "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "mirror"}]})");
}

vec3 beautyOf(const Pixel& pixel) {
    vec3 beauty{0};
    for (const vec3& layer : pixel.mean.layers) beauty += layer;
    return beauty;
}

// Whatever absorbs nothing vanishes, alone or among others of its kind: every pixel is the sky's in the mean.
TEST(Sky, WhiteThingsVanish) {
    json scene = furnace();
    scene["camera"]["origin"] = {0, 0, 12};
    scene["film"]["size"] = {70, 16};
    scene["camera"]["fieldOfView"] = 12;
    scene["shapes"] = json::array();
    const char* const materials[]{"diffuse", "mirror", "glass", "metal", "plastic"};
    for (int i = 0; i < 5; i++)
        scene["shapes"].push_back(
            {{"type", "sphere"}, {"center", {2.2 * i - 4.4, 0, 0}}, {"radius", 1}, {"material", materials[i]}});
    const Scene loaded = loadJson(scene);
    for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH}) {
        Settings settings = loaded.settings;
        settings.integrator = integrator;
        const Rendered image = renderPasses(loaded, settings, integrator == INTEGRATOR_PHOTON ? 24 : 64);
        EXPECT_EQ(image.nonfinite, 0u);
        dvec3 sums[5]{};
        for (uint i = 0; i < image.pixels.size(); i++) sums[i % 70 / 14] += dvec3{beautyOf(image.pixels[i])};
        for (int i = 0; i < 5; i++) {
            const dvec3 mean = sums[i] / double(image.pixels.size() / 5);
            std::printf("%-8s %.4f %.4f %.4f\n", materials[i], mean.x, mean.y, mean.z);
            EXPECT_NEAR(mean.x, 0.5, 4e-3) << materials[i] << integrator;
            EXPECT_NEAR(mean.y, 1, 8e-3) << materials[i] << integrator;
            EXPECT_NEAR(mean.z, 2, 16e-3) << materials[i] << integrator;
        }
    }
}

// Alone, mirrors and glass vanish without noise.
TEST(Sky, AMirrorShowsTheSkyItself) {
    for (const char* material : {"mirror", "glass"}) {
        json scene = furnace();
        scene["shapes"][0]["material"] = material;
        const Scene loaded = loadJson(scene);
        for (const Pixel& pixel : renderPasses(loaded, loaded.settings, 2).pixels)
            EXPECT_LT(glm::length(beautyOf(pixel) / vec3(0.5, 1, 2) - 1.0f), 1e-5) << material;
    }
}

// All photons escape an empty sky, and nothing else is seen than the sky.
TEST(Sky, ABlackThingAddsNothing) {
    json scene = furnace();
    scene["materials"]["black"] = {{"type", "diffuse"}, {"albedo", 0}};
    scene["shapes"][0]["material"] = "black";
    scene["shapes"][0]["center"] = {0, 0, 9};
    const Scene loaded = loadJson(scene);
    const Rendered image = renderPasses(loaded, loaded.settings, 1);
    for (const Pixel& pixel : image.pixels) {
        EXPECT_EQ(pixel.mean.layers[LAYER_EMISSION], vec3(0.5, 1, 2));
        EXPECT_EQ(pixel.mean.covered, 0);
        for (uint layer = 1; layer < LAYER_COUNT; layer++) EXPECT_EQ(pixel.mean.layers[layer], vec3(0));
    }
    EXPECT_EQ(image.global.emitted, image.global.escaped + image.global.absorbed);
}

/// A gradient from north to east to zenith, so that every turn shows.
vec3 gradient(uint x, uint y, uint width, uint height) {
    const double angle = pi * (y + 0.5) / height, turn = 2 * pi * ((x + 0.5) / width - 0.5);
    const vec3 w{std::sin(angle) * std::sin(turn), std::cos(angle), -std::sin(angle) * std::cos(turn)};
    return 0.5f + 0.4f * w;
}

// The picture's middle is seen towards -z, its right towards +x, its upper edge up; a rotation turns it about up.
TEST(Sky, LiesAsThePageSays) {
    writeHdr("gradient.hdr", 60, 30, [](uint x, uint y) { return gradient(x, y, 60, 30); });
    const auto seen = [](dvec3 towards, const json& environment) {
        json scene = furnace();
        scene["environment"] = environment;
        scene["camera"] = {{"origin", {0, 0, 0}},
                           {"target", {towards.x, towards.y, towards.z}},
                           {"up", {0.3, 0.5, 0.7}},
                           {"fieldOfView", 1}};
        scene["film"]["size"] = {4, 4};
        scene["shapes"][0]["material"] = "diffuse";
        scene["shapes"][0]["center"] = {-3 * towards.x, -3 * towards.y, -3 * towards.z};
        const Scene loaded = loadJson(scene);
        return (renderPasses(loaded, loaded.settings, 1).pixels[5].mean.layers[LAYER_EMISSION] - 0.5f) / 0.4f;
    };
    const json plain{{"image", "gradient.hdr"}};
    const dvec3 w = glm::normalize(dvec3{0.3, 0.4, -0.6});
    EXPECT_LT(glm::length(dvec3{seen(w, plain)} - w), 0.1);
    EXPECT_LT(glm::length(dvec3{seen(-w, plain)} + w), 0.1);
    // A quarter turn brings what is at -z to -x, as seen from above against the clock.
    EXPECT_LT(glm::length(dvec3{seen({-1, 0, 0}, {{"image", "gradient.hdr"}, {"rotation", 90}})} - dvec3{0, 0, -1}),
              0.1);
    // z up: the middle is +y.
    EXPECT_LT(glm::length(dvec3{seen({0, 0, 1}, {{"image", "gradient.hdr"}, {"up", {0, 0, 1}}})} - dvec3{0, 1, 0}),
              0.1);
    EXPECT_LT(glm::length(dvec3{seen({0, 1, 0}, {{"image", "gradient.hdr"}, {"up", {0, 0, 1}}})} - dvec3{0, 0, -1}),
              0.1);
    EXPECT_LT(glm::length(dvec3{seen({1, 0, 0}, {{"image", "gradient.hdr"}, {"up", {0, 0, 1}}})} - dvec3{1, 0, 0}),
              0.1);
}

// A sky brings a plane what a quadrature says, whatever its size, and however it is turned.
TEST(Sky, IrradianceIsThatOfItsTexels) {
    for (const auto& [width, height] : {std::pair(60u, 30u), {7u, 3u}, {2u, 1u}}) {
        writeHdr("gradient.hdr", width, height,
                 [w = width, h = height](uint x, uint y) { return gradient(x, y, w, h); });
        const Scene loaded = [&] {
            json scene = floorScene();
            scene["environment"] = {{"image", "gradient.hdr"}};
            return loadJson(scene);
        }();
        const uint columns = loaded.sky.width, rows = loaded.sky.height;
        dvec3 expected{0};
        for (uint y = 0; y < rows; y++) {
            const double from = std::cos(pi * y / rows), to = std::max(0.0, std::cos(pi * (y + 1) / rows));
            for (uint x = 0; x < columns && from > 0; x++)
                expected += dvec3{loaded.skyTexels[std::size_t(y) * columns + x].radiance} *
                            (pi * (from * from - to * to) / columns);
        }
        for (const double degrees : {0.0, 90.0, 33.0}) {
            json scene = floorScene();
            scene["environment"] = {{"image", "gradient.hdr"}, {"rotation", degrees}};
            const double mean = (expected.x + expected.y + expected.z) / 3;
            EXPECT_NEAR(irradiance(scene, 64) / mean, 1, 3e-3) << width << " " << degrees;
        }
    }
}

/// Everything at once: a sky, a large and a small sun, a spot; mirror, glass, gold, floor and wall.
json mixedScene() {
    return json::parse(R"({
        "camera": {"origin": [0, 2.2, 6], "target": [0, 0.5, 0]},
        "film": {"size": [24, 18]}, "settings": {"photons": 20000, "causticPhotons": 20000, "radius": 0.05, "causticRadius": 0.05},
        "environment": {"image": "gradient.hdr", "strength": [0.5, 0.6, 0.8], "rotation": 40},
        "lights": [{"type": "sun", "direction": [0.5, 1, 0.4], "irradiance": [2, 1.8, 1.4], "angle": 16}],
        "materials": {"white": {"type": "diffuse", "albedo": [0.7, 0.6, 0.5]}, "mirror": {"type": "mirror", "reflectance": 0.9},
                      "glass": {"type": "glass", "ior": 1.5}, "gold": {"type": "metal", "preset": "gold", "roughness": 0.5}},
        "shapes": [{"type": "rectangle", "corner": [-4, -1, 4], "edges": [[8, 0, 0], [0, 0, -8]], "material": "white"},
                   {"type": "rectangle", "corner": [-4, -1, -2.5], "edges": [[8, 0, 0], [0, 3, 0]], "material": "white"},
                   {"type": "sphere", "center": [-2.2, 0, 0], "radius": 1, "material": "white"},
                   {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "mirror"},
                   {"type": "sphere", "center": [0, 1.7, 1], "radius": 0.5, "material": "gold"},
                   {"type": "sphere", "center": [2.2, 0, 0], "radius": 1, "material": "glass"}]})");
}

std::map<uint, Estimate> layersOf(const Scene& scene, Settings settings, uint passes, uint seeds = 3) {
    std::map<uint, std::vector<double>> values;
    for (uint seed = 0; seed < seeds; seed++) {
        settings.seed = 40 + seed;
        const Rendered image = renderPasses(scene, settings, passes);
        EXPECT_EQ(image.nonfinite, 0u);
        for (uint layer = 0; layer <= LAYER_COUNT; layer++) values[layer].push_back(layerMean(image.pixels, layer));
    }
    std::map<uint, Estimate> result;
    for (const auto& [layer, list] : values) result[layer] = estimate(list);
    return result;
}

void expectSameLayers(const Scene& scene, uint photonPasses, uint pathPasses, double allowed, uint from = 0) {
    Settings settings = scene.settings;
    const auto photon = layersOf(scene, settings, photonPasses);
    settings.integrator = INTEGRATOR_PATH;
    const auto path = layersOf(scene, settings, pathPasses);
    for (uint layer = from; layer <= LAYER_COUNT; layer++) {
        const Estimate a = photon.at(layer), b = path.at(layer);
        std::printf("layer %u photon %.5f +- %.5f path %.5f +- %.5f z %+.2f\n", layer, a.mean, a.error, b.mean, b.error,
                    zScore(a, b));
        const double room = 5 * std::hypot(a.error, b.error) + 0.02 * b.mean;
        EXPECT_NEAR(a.mean, b.mean, room) << layer;
        EXPECT_LE(room, allowed * b.mean) << layer << ": the noise is too great to see an error";
    }
}

TEST(Sky, EachLayerIsThatOfThePathTracer) {
    writeHdr("gradient.hdr", 60, 30, [](uint x, uint y) { return gradient(x, y, 60, 30); });
    expectSameLayers(loadJson(mixedScene()), 4, 64, 0.5);
}

/// One of each kind of light, above a floor at y = 0.
std::map<std::string, json> lightings() {
    writeHdr("gradient.hdr", 60, 30, [](uint x, uint y) { return gradient(x, y, 60, 30); });
    const auto lamp = [](const char* text) { return json{{"lights", {json::parse(text)}}}; };
    return {
        {"sun", lamp(R"({"type": "sun", "direction": [1, 3, 1], "irradiance": 3})")},
        {"wide sun", lamp(R"({"type": "sun", "direction": [1, 2, 0], "irradiance": 3, "angle": 60})")},
        {"point", lamp(R"({"type": "point", "position": [0.3, 1.5, 0.2], "intensity": 5})")},
        {"far point", lamp(R"({"type": "point", "position": [9, 30, 3], "intensity": 2500})")},
        {"spot", lamp(R"({"type": "spot", "position": [0.3, 1.5, 0.2], "direction": [-0.3, -1.5, -0.2], "intensity": 5,
                          "inner": 15, "outer": 45})")},
        {"spot with a radius", lamp(R"({"type": "spot", "position": [0.3, 1.5, 0.2], "direction": [-0.3, -1.5, -0.2],
                                        "intensity": 5, "inner": 15, "outer": 45, "radius": 0.2})")},
        {"point with a radius",
         lamp(R"({"type": "point", "position": [0.3, 1.5, 0.2], "intensity": 5, "radius": 0.2})")},
        {"sky", json{{"environment", {{"image", "gradient.hdr"}}}}}};
}

json lit(const json& lighting) {
    json scene = floorScene();
    scene["camera"] = {{"origin", {0, 1, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, -1}}, {"fieldOfView", 60}};
    scene["film"]["size"] = {20, 20};
    scene.update(lighting);
    return scene;
}

// Photons bring a floor that absorbs all what light samples bring it, from each kind of light.
TEST(Lamps, PhotonsBringWhatLightSamplesBring) {
    SKIP_UNLESS_DRAWN(1);
    for (const auto& [name, lighting] : lightings()) {
        json scene = lit(lighting);
        const double samples = irradiance(scene, 16) / pi;
        scene["materials"]["white"]["albedo"] = 0;
        scene["settings"] = {{"photons", 100000}, {"radius", 0.05}, {"layers", {"indirect"}}};
        const Scene black = loadJson(scene);
        Settings settings = black.settings;
        settings.integrator = INTEGRATOR_PHOTON_MAP;
        const double photons = layerMean(renderPasses(black, settings, 1).pixels, LAYER_INDIRECT);
        std::printf("%-20s light samples %.5f photons %.5f\n", name.c_str(), samples, photons);
        EXPECT_NEAR(photons / samples, 1, 0.02) << name;
    }
}

// A lamp without a size is seen through frosted glass by light samples alone, a small one by rays as well.
TEST(Lamps, ShineThroughFrostedGlass) {
    SKIP_UNLESS_DRAWN(0);
    if (!isThorough()) GTEST_SKIP() << "takes as long as the others together: tools/test --all";
    for (const double roughness : {0.45, 0.6}) { // labels G and W
        const json glass{
            {"type", "glass"}, {"ior", 1.5}, {"roughness", roughness}, {"abbe", roughness > 0.5 ? 15 : 100}};
        const auto seen = [&](double radius) {
            const json lamp{{"type", "point"}, {"position", {0.3, 0.2, -2}}, {"intensity", 1}, {"radius", radius}};
            const Scene scene = loadJson(
                {{"camera", {{"origin", {0, 0, 2}}, {"target", {0, 0, 0}}, {"fieldOfView", 36}}},
                 {"film", {{"size", {24, 24}}}},
                 {"lights", {lamp}},
                 {"materials", {{"glass", glass}}},
                 {"shapes", {{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 0.5}, {"material", "glass"}}}}});
            std::vector<double> means;
            for (uint seed = 0; seed < 5; seed++) {
                Settings settings = scene.settings;
                settings.seed = seed;
                means.push_back(layerMean(renderPasses(scene, settings, radius > 0 ? 48 : 16).pixels, LAYER_COUNT));
            }
            return estimate(means);
        };
        const Estimate point = seen(0), small = seen(0.04);
        std::printf("frosted: point %.5f +- %.5f, small lamp %.5f +- %.5f\n", point.mean, point.error, small.mean,
                    small.error);
        EXPECT_LT(std::abs(zScore(point, small)), 4) << roughness;
        EXPECT_LT(std::max(small.error, point.error), 0.02 * small.mean) << roughness;
    }
}

// Balls of index 1 change nothing: what they take from direct light comes as their caustic.
TEST(Lamps, CausticsAreWhatShadowsLack) {
    SKIP_UNLESS_DRAWN(1);
    if (!isThorough()) GTEST_SKIP() << "takes as long as the others together: tools/test --all";
    for (const auto& [name, lighting] : lightings()) {
        json scene = lit(lighting);
        const double without = irradiance(scene, 16) / pi;
        scene["materials"]["air"] = {{"type", "glass"}, {"ior", 1}};
        for (const double x : {-0.15, 0.1, 0.2}) // two overlap as seen from above
            scene["shapes"].push_back(
                {{"type", "sphere"}, {"center", {x, 0.5 + x, 0}}, {"radius", 0.12}, {"material", "air"}});
        scene["settings"] = {{"photons", 0},
                             {"causticPhotons", 15000},
                             {"causticRadius", 0.02},
                             {"layers", {"direct", "specular", "caustic"}}};
        const Scene loaded = loadJson(scene);
        const std::vector<Pixel> pixels = renderPasses(loaded, loaded.settings, 4).pixels;
        const double caustic = layerMean(pixels, LAYER_CAUSTIC), all = layerMean(pixels, LAYER_COUNT);
        std::printf("%-20s without balls %.5f with %.5f, of that caustic %.5f\n", name.c_str(), without, all, caustic);
        EXPECT_GT(caustic, 0.005 * without) << name;
        EXPECT_NEAR(all / without, 1, 0.015) << name;
    }
}

// The ground goes on for thousands of its things, and photons still come to where these are, and are as many as the
// sky's radiance asks for: the map's own radiance of the ground is the sky's.
TEST(Sky, PhotonsFindTheMiddleOfAWidePlain) {
    const Scene scene = loadJson(json::parse(R"({
        "camera": {"origin": [0, 0.5, 0.5], "target": [0, 0, 0.5], "up": [0, 0, -1], "fieldOfView": 60},
        "film": {"size": [16, 16]}, "settings": {"photons": 400000, "radius": 0.1, "layers": ["indirect"]},
        "environment": {"radiance": 1},
        "materials": {"white": {"type": "diffuse", "albedo": 0.5}, "black": {"type": "diffuse", "albedo": 0}},
        "shapes": [{"type": "rectangle", "corner": [-4000, 0, 4000], "edges": [[8000, 0, 0], [0, 0, -8000]], "material": "white"},
                   {"type": "sphere", "center": [0.3, 0.02, 0], "radius": 0.02, "material": "white"},
                   {"type": "sphere", "center": [-0.3, 0.02, 0], "radius": 0.02, "material": "white"},
                   {"type": "sphere", "center": [0, 0.02, -0.3], "radius": 0.02, "material": "white"}]})"));
    EXPECT_GT(scene.discCount, 6u);
    Settings settings = scene.settings;
    settings.integrator = INTEGRATOR_PHOTON_MAP;
    const double mean = layerMean(renderPasses(scene, settings, 1).pixels, LAYER_INDIRECT);
    std::printf("radiance by the map: %.4f, with %u discs\n", mean, scene.discCount);
    EXPECT_NEAR(mean, 1, 0.03);
}

// Unseen directly, and seen in mirrors; what surfaces cover is known.
TEST(Sky, MayBeUnseen) {
    json scene = furnace();
    scene["environment"]["visible"] = false;
    scene["shapes"][0]["material"] = "mirror";
    const Scene loaded = loadJson(scene);
    EXPECT_TRUE(loaded.settings.coverage);
    const std::vector<Pixel> pixels = renderPasses(loaded, loaded.settings, 4).pixels;
    EXPECT_EQ(layerMean(pixels, LAYER_EMISSION), 0);
    EXPECT_EQ(pixels[0].mean.covered, 0);
    const Pixel& middle = pixels[16 * 32 + 16];
    EXPECT_EQ(middle.mean.covered, 1);
    EXPECT_NEAR(middle.mean.layers[LAYER_SPECULAR].y, 1, 1e-3);
}

// Colours of 8 bits are of sRGB, those of 16 linear; opacity counts for nothing.
TEST(Sky, IsReadFromPng) {
    writeScene(pngBytes<unsigned char>(1, 2, {255, 188, 0, 255, 10, 55, 128, 0}), "narrow.png");
    writeScene(pngBytes<std::uint16_t>(1, 2, {65535, 32768, 0, 65535, 1, 2, 3, 65535}), "wide.png");
    const auto texels = [](const char* file) {
        json scene = floorScene();
        scene["environment"] = {{"image", file}, {"strength", 2}};
        std::vector<vec3> radiances;
        for (const SkyTexel& texel : loadJson(scene).skyTexels) radiances.push_back(texel.radiance);
        return radiances;
    };
    const auto near = [](vec3 found, vec3 expected) { return glm::length(found - 2.0f * expected) < 2e-6; };
    const auto narrow = texels("narrow.png"), wide = texels("wide.png");
    ASSERT_EQ(narrow.size(), 2u);
    EXPECT_PRED2(near, narrow[0], vec3(1, 0.50288646f, 0)); // IEC 61966-2-1
    EXPECT_PRED2(near, narrow[1], vec3(0.00303527f, 0.03820437f, 0.21586050f));
    ASSERT_EQ(wide.size(), 2u);
    EXPECT_PRED2(near, wide[0], vec3(1, 32768 / 65535.0f, 0));
    EXPECT_PRED2(near, wide[1], vec3(1, 2, 3) / 65535.0f);
}

TEST(Sky, RefusalsNamePlaceAndLimit) {
    const auto refusal = [](const json& environment) {
        json scene = floorScene();
        scene["environment"] = environment;
        return errorOf(scene);
    };
    EXPECT_THAT(refusal({{"radiance", 1}, {"image", "a.hdr"}}), HasSubstr("/environment: found both"));
    EXPECT_THAT(refusal(json::object()), HasSubstr("/environment: found neither"));
    EXPECT_THAT(refusal({{"radiance", -1}}), HasSubstr("/environment/radiance: found -1"));
    EXPECT_THAT(refusal({{"radiance", 0}}), HasSubstr("there is no light"));
    EXPECT_THAT(refusal({{"image", "none.hdr"}}), HasSubstr("/environment/image: "));
    EXPECT_THAT(refusal({{"radiance", 1}, {"rotation", 3}}), HasSubstr("/environment/rotation: unknown key"));
    writeScene("#?RADIANCE\n\n-Y 8192 +X 16384\n", "large.hdr");
    EXPECT_THAT(refusal({{"image", "large.hdr"}}), HasSubstr("found 16384 x 8192 texels, 1.54e+03 MiB"));
    writeScene("#?RADIANCE\n\n-Y 8 +X 16\nabc", "short.hdr");
    EXPECT_THAT(refusal({{"image", "short.hdr"}}), HasSubstr("the file ends early"));
    for (const float bad : {NAN, INFINITY, -1.0f}) {
        const std::vector<float> ones(6, 1.0f);
        Image image{.size = {3, 2}, .channels = {{"R", ones}, {"G", ones}, {"B", ones}}};
        image.channels[1].values[4] = image.channels[2].values[5] = bad;
        writeExr(writeScene("", "bad.exr"), image);
        EXPECT_THAT(refusal({{"image", "bad.exr"}}), HasSubstr("2 texels are negative or not finite, the first, (1, "));
        EXPECT_THAT(refusal({{"image", "bad.exr"}}), HasSubstr("in row 1, column 1, from 0"));
    }
    writeScene("GIF89a", "other.hdr");
    EXPECT_THAT(refusal({{"image", "other.hdr"}}), HasSubstr("allowed is a PNG, JPEG, OpenEXR or Radiance image"));
    json scene = floorScene();
    scene["lights"] = {sun({0, 0, 0}, 1)};
    EXPECT_THAT(errorOf(scene), HasSubstr("/lights/0/direction: the direction has length 0"));
    scene["lights"] = {{{"type", "spot"},
                        {"position", {0, 1, 0}},
                        {"direction", {0, 1, 0}},
                        {"intensity", 1},
                        {"inner", 5},
                        {"outer", 4}}};
    EXPECT_THAT(errorOf(scene), HasSubstr("/lights/0/inner: the inner angle is wider"));
    scene["lights"] = {{{"type", "lamp"}}};
    EXPECT_THAT(errorOf(scene), HasSubstr("/lights/0/type: "));
}

} // namespace
} // namespace vkpm
