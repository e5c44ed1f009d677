/// Media within glass: what is left of light on its way, what counts where glass overlaps, and colours apart.
#include "render_support.h"
#include "scene/identity.h"
#include "scene/media.h"
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;
using nlohmann::json;

/// A block between two heights, as a closed mesh of rectangles that overlap nowhere.
void addBlock(json& shapes, const std::string& material, dvec3 low, dvec3 high) {
    for (int axis = 0; axis < 3; axis++)
        for (const bool upper : {false, true}) {
            dvec3 corner = low, u{0}, v{0};
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            u[a] = high[a] - low[a];
            v[b] = high[b] - low[b];
            if (upper) corner[axis] = high[axis];
            else std::swap(u, v);
            shapes.push_back({{"type", "rectangle"},
                              {"material", material},
                              {"corner", {corner.x, corner.y, corner.z}},
                              {"edges", {{u.x, u.y, u.z}, {v.x, v.y, v.z}}}});
        }
}

json glass(double ior) { return {{"type", "glass"}, {"ior", ior}}; }

/// Seen from above, straight down, through whatever is added: a bright floor, or a bright sky for what is reflected.
json straightDown(bool reflection) {
    const json emission{{"type", "rectangle"}, {"emission", 1}};
    json light = emission;
    light["corner"] = {-50, reflection ? 9 : -9, reflection ? -50 : 50};
    light["edges"] = {{100, 0, 0}, {0, 0, reflection ? 100 : -100}};
    return {{"camera", {{"origin", {0, 5, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, 1}}, {"fieldOfView", 0.1}}},
            {"film", {{"size", {8, 8}}}},
            {"settings", {{"seed", 3}}},
            {"shapes", json::array({light})}};
}

const double pi = glm::pi<double>();

double brightness(const json& scene, uint passes = 128, uint integrator = INTEGRATOR_PATH) {
    Scene loaded = loadJson(scene);
    loaded.settings.integrator = integrator;
    return layerMean(renderPasses(loaded, loaded.settings, passes).pixels, LAYER_COUNT);
}

double normalReflectance(double a, double b) { return std::pow((a - b) / (a + b), 2); }

const double apart = 2e-3;

TEST(Media, SlabThatTakesLightAway) {
    for (const bool reflection : {false, true}) {
        json scene = straightDown(reflection);
        scene["materials"]["green"] = glass(1.5);
        scene["materials"]["green"]["attenuation"] = {{"color", 0.5}, {"distance", 2}};
        addBlock(scene["shapes"], "green", {-9, -1, -9}, {9, 1, 9});
        EXPECT_NEAR(brightness(scene, 256), reflection ? 0.0492 : 0.4610, apart);
    }
}

// What 2^-(x way) is, in the range of floats and beyond it.
TEST(Media, ExtremeAttenuations) {
    for (const double distance : {1e-30, 1e30, 1.0}) {
        json scene = straightDown(false);
        scene["materials"]["gas"] = glass(1);
        scene["materials"]["gas"]["attenuation"] = {{"color", {0.5, 0, 1}}, {"distance", distance}};
        scene["shapes"].push_back({{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 0.5}, {"material", "gas"}});
        const double seen = distance > 1 ? 2.0 / 3 : distance < 1 ? 1.0 / 3 : 0.5;
        EXPECT_NEAR(brightness(scene, 4), seen, 1e-5) << distance;
    }
}

// A scene twice as large whose light goes twice as far.
TEST(Media, ScaleWithTheScene) {
    const auto render = [](double scale) {
        json scene = straightDown(false);
        scene["camera"]["origin"] = {0, 5 * scale, 0};
        scene["materials"]["green"] = glass(1.5);
        scene["materials"]["green"]["attenuation"] = {{"color", {0.5, 0.9, 0.1}}, {"distance", 2 * scale}};
        addBlock(scene["shapes"], "green", dvec3{-9, -1, -9} * scale, dvec3{9, 1, 9} * scale);
        return brightness(scene, 4);
    };
    EXPECT_EQ(render(1), render(0x1p-20));
}

// Water that reaches into the glass that holds it: where both are, the glass counts, whichever was entered first.
TEST(Media, PriorityWhereGlassOverlaps) {
    for (const bool glassAbove : {false, true}) {
        json scene = straightDown(false);
        scene["materials"]["glass"] = glass(1.9);
        scene["materials"]["glass"]["priority"] = 1;
        scene["materials"]["water"] = glass(1.2);
        scene["materials"]["water"]["attenuation"] = {{"color", 0.5}, {"distance", 2}};
        const double sign = glassAbove ? 1 : -1;
        const auto add = [&](const char* material, double from, double to) {
            addBlock(scene["shapes"], material, {-9, std::min(sign * from, sign * to), -9},
                     {9, std::max(sign * from, sign * to), 9});
        };
        add("glass", 0, 1);
        add("water", -1, 0.5);
        // Air, glass, a way of 1 through water, air.
        const double a = normalReflectance(1, 1.9), b = normalReflectance(1.9, 1.2), c = normalReflectance(1.2, 1);
        const double loss = std::sqrt(0.5);
        const double glassT = (1 - a) * (1 - b) / (1 - a * b), fromBelow = b + (1 - b) * (1 - b) * a / (1 - a * b);
        const double expected = glassT * loss * (1 - c) / (1 - fromBelow * c * loss * loss);
        EXPECT_NEAR(brightness(scene, 256), expected, apart) << glassAbove;
    }
}

// Water that stands on glass, face to face, is seen like water that reaches into it.
TEST(Media, FacesThatLieOnEachOther) {
    const double a = normalReflectance(1, 1.9), b = normalReflectance(1.9, 1.2), c = normalReflectance(1.2, 1);
    const double glassT = (1 - a) * (1 - b) / (1 - a * b), fromBelow = b + (1 - b) * (1 - b) * a / (1 - a * b);
    const double expected = glassT * (1 - c) / (1 - fromBelow * c);
    for (const double gap : {0.0, 1e-8})
        for (const bool first : {false, true})
            for (const bool upward : {false, true})
                for (const double place : {0.0, 0.3}) {
                    json scene = straightDown(false);
                    scene["materials"]["glass"] = glass(1.9);
                    scene["materials"]["water"] = glass(1.2);
                    const auto add = [&](bool ofGlass) {
                        const double low = place + (ofGlass ? gap : -1), high = place + (ofGlass ? 1 : 0);
                        addBlock(scene["shapes"], ofGlass ? "glass" : "water", {-9, upward ? low : -high, -9},
                                 {9, upward ? high : -low, 9});
                    };
                    add(first);
                    add(!first);
                    EXPECT_NEAR(brightness(scene, 256), expected, apart) << gap << first << upward << place;
                }
    // And glass on glass of its own kind is one block.
    json scene = straightDown(false);
    scene["materials"]["glass"] = glass(1.9);
    for (const double low : {0, 1, 2}) addBlock(scene["shapes"], "glass", {-9, low, -9}, {9, low + 1, 9});
    EXPECT_NEAR(brightness(scene, 256), (1 - a) / (1 + a), apart);
}

json nestedBalls(bool byHand) {
    json scene = smallScene();
    scene["settings"] = {{"photons", 4096}, {"causticPhotons", 4096}, {"seed", 5}};
    scene["film"] = {{"size", {24, 24}}};
    scene["materials"] = {{"grey", {{"type", "diffuse"}, {"albedo", 0.6}}},
                          {"outer", glass(1.5)},
                          {"water", glass(1.33)},
                          {"inner", glass(1.7)}};
    if (byHand) scene["materials"]["water"]["exteriorIor"] = 1.5;
    if (byHand) scene["materials"]["inner"]["exteriorIor"] = 1.33;
    const auto ball = [](const char* material, double radius) {
        return json{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", radius}, {"material", material}};
    };
    scene["shapes"] = {
        ball("outer", 0.9),
        ball("water", 0.7),
        ball("inner", 0.4),
        {{"type", "rectangle"}, {"corner", {-3, -1, 3}}, {"edges", {{6, 0, 0}, {0, 0, -6}}}, {"material", "grey"}},
        {{"type", "rectangle"}, {"corner", {-1, 3, -1}}, {"edges", {{2, 0, 0}, {0, 0, 2}}}, {"emission", 5}}};
    return scene;
}

// Found by the paths or given by hand, indices outside are the same.
TEST(Media, GlassInWaterInGlass) {
    const Scene found = loadJson(nestedBalls(false)), given = loadJson(nestedBalls(true));
    EXPECT_FALSE(found.media.empty());
    EXPECT_TRUE(given.media.empty());
    const auto means = [](const Scene& scene, uint layer, uint integrator) {
        std::vector<double> values;
        for (uint seed = 0; seed < 6; seed++) {
            Settings settings = scene.settings;
            settings.seed = seed;
            settings.integrator = integrator;
            values.push_back(layerMean(renderPasses(scene, settings, 8).pixels, layer));
        }
        return estimate(values);
    };
    for (const uint layer : {LAYER_SPECULAR, LAYER_CAUSTIC})
        for (const uint integrator : {INTEGRATOR_PATH, INTEGRATOR_PHOTON}) {
            const Estimate a = means(found, layer, integrator), b = means(given, layer, integrator);
            EXPECT_LT(std::abs(a.mean - b.mean), 4 * std::hypot(a.error, b.error) + 1e-6) << layer << integrator;
            EXPECT_GT(a.mean, 0) << layer;
        }
}

// From outside one sees the same, whether a path knows what is outside or was told; by hand and by stack together.
TEST(Media, WhatIsOutsideByHandBesideMedia) {
    json scene = nestedBalls(true);
    scene["materials"]["outer"]["attenuation"] = {{"color", 1}, {"distance", 1}};
    scene["materials"]["outer"]["abbe"] = 1e30; // media, and nothing else that is new
    const Scene loaded = loadJson(scene), given = loadJson(nestedBalls(true));
    ASSERT_FALSE(loaded.media.empty());
    Settings settings = given.settings;
    settings.integrator = INTEGRATOR_PATH;
    const double a = layerMean(renderPasses(loaded, settings, 16).pixels, LAYER_SPECULAR);
    const double b = layerMean(renderPasses(given, settings, 16).pixels, LAYER_SPECULAR);
    EXPECT_NEAR(a, b, 1e-3 * b);
}

TEST(Media, PlacesKnowWhatTheyAreIn) {
    const Scene scene = loadJson(nestedBalls(false));
    const MediaLocator locator{scene};
    const auto iors = [&](dvec3 place) {
        std::vector<float> found;
        for (uint media = locator.at(place / scene.coordinates.unit); media != 0; media >>= MEDIUM_BITS)
            found.push_back(scene.media[media & (MAX_MEDIA - 1)].ior);
        return found;
    };
    EXPECT_EQ(iors({0, 0, 0}), (std::vector{1.7f, 1.33f, 1.5f}));
    EXPECT_EQ(iors({0.5, 0, 0}), (std::vector{1.33f, 1.5f}));
    EXPECT_EQ(iors({0, 0.8, 0}), (std::vector{1.5f}));
    EXPECT_EQ(iors({0, 1, 0}), std::vector<float>{});
}

// From the middle of a ball of gas, half of the light of what is around comes.
TEST(Media, CameraAndLampWithin) {
    json scene = straightDown(false);
    scene["materials"]["gas"] = glass(1);
    scene["materials"]["gas"]["attenuation"] = {{"color", 0.5}, {"distance", 2}};
    scene["shapes"].push_back({{"type", "sphere"}, {"center", {0, 5, 0}}, {"radius", 2}, {"material", "gas"}});
    EXPECT_NEAR(brightness(scene, 4), 0.5, 1e-6);
    EXPECT_NEAR(brightness(scene, 4, INTEGRATOR_PHOTON), 0.5, 1e-6);

    // A lamp in the gas and a floor outside: its light arrives through the map, and by the path tracer, alike.
    json lamp = smallScene();
    lamp["film"] = {{"size", {8, 8}}};
    lamp["settings"] = {
        {"photons", 0}, {"causticPhotons", 20000}, {"radius", 0.1}, {"causticRadius", 0.1}, {"seed", 1}};
    lamp["camera"] = {{"origin", {0, 5, 0}}, {"target", {0, 0, 0}}, {"up", {0, 0, 1}}, {"fieldOfView", 3}};
    lamp["materials"] = {{"grey", {{"type", "diffuse"}, {"albedo", 1}}}, {"gas", scene["materials"]["gas"]}};
    lamp["shapes"] = {
        {{"type", "sphere"}, {"center", {0, 1.5, 0}}, {"radius", 0.2}, {"emission", 30}},
        {{"type", "sphere"}, {"center", {0, 1.5, 0}}, {"radius", 1.2}, {"material", "gas"}},
        {{"type", "rectangle"}, {"corner", {-9, 0, 9}}, {"edges", {{18, 0, 0}, {0, 0, -18}}}, {"material", "grey"}}};
    lamp["camera"]["origin"] = {2.5, 5, 0};
    lamp["camera"]["target"] = {2.5, 0, 0};
    // Ways within the gas are 1 long, from a lamp that looks nearly like a point.
    const double distance2 = 2.5 * 2.5 + 1.5 * 1.5, cosine = 1.5 / std::sqrt(distance2);
    const double expected = 30 * pi * 0.04 / distance2 * cosine / pi * std::sqrt(0.5);
    EXPECT_NEAR(brightness(lamp, 24, INTEGRATOR_PHOTON), expected, 0.02 * expected);
}

TEST(Media, DispersionHasNoCast) {
    json scene = nestedBalls(false);
    scene["materials"]["outer"]["abbe"] = 20;
    scene["materials"]["inner"]["abbe"] = 30;
    const Scene loaded = loadJson(scene);
    for (const uint integrator : {INTEGRATOR_PATH, INTEGRATOR_PHOTON}) {
        std::array<std::vector<double>, 2> differences; // of red and blue from green
        for (uint seed = 0; seed < 8; seed++) {
            Settings settings = loaded.settings;
            settings.integrator = integrator;
            settings.seed = seed;
            dvec3 sum{0};
            for (const Pixel& pixel : renderPasses(loaded, settings, 6).pixels)
                for (const vec3& layer : pixel.mean.layers) sum += dvec3{layer};
            differences[0].push_back(sum.x / sum.y - 1);
            differences[1].push_back(sum.z / sum.y - 1);
        }
        for (const auto& values : differences) {
            const Estimate cast = estimate(values);
            EXPECT_LT(std::abs(cast.mean), 4 * cast.error + 0.003) << integrator;
        }
    }
}

// Two interfaces of 4 %: 1 - 2 r / (1 + r) goes through, straight.
TEST(Media, SheetsOfGlass) {
    for (const bool reflection : {false, true}) {
        json scene = straightDown(reflection);
        scene["materials"]["pane"] = glass(1.5);
        scene["materials"]["pane"]["thin"] = true;
        scene["materials"]["pane"]["tint"] = 0.5;
        scene["shapes"].push_back({{"type", "rectangle"},
                                   {"corner", {-5, 0, 5}},
                                   {"edges", {{10, 0, 0}, {0, 0, -10}}},
                                   {"material", "pane"}});
        EXPECT_NEAR(brightness(scene, 256), reflection ? 0.0769 : 0.4615, apart);
    }
}

TEST(Media, AFifthMediumIsCounted) {
    json scene = nestedBalls(false);
    const Scene four = loadJson(scene);
    for (const double radius : {0.3, 0.2, 0.1}) {
        const std::string name = "ball " + std::to_string(radius);
        scene["materials"][name] = glass(1 + radius);
        scene["shapes"].push_back({{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", radius}, {"material", name}});
    }
    const Scene six = loadJson(scene);
    for (const Scene* loaded : {&four, &six}) {
        Renderer renderer(testGpu(), *loaded, loaded->settings);
        renderer.renderPass(0);
        EXPECT_EQ(renderer.mediaOverflows() > 0, loaded == &six);
    }
}

// What fills glass is a part of what a scene is, for those who go on with a render.
TEST(Media, CountForTheIdentity) {
    json scene = smallScene();
    scene["materials"]["water"]["priority"] = 1;
    scene["shapes"][0]["material"] = "water";
    const auto hashOf = [](const json& with) {
        const Scene loaded = loadJson(with);
        return identityOf(loaded, loaded.settings).at("sceneHash");
    };
    const std::string hash = hashOf(scene);
    EXPECT_EQ(hashOf(scene), hash);
    json other = scene;
    other["materials"]["water"]["abbe"] = 30;
    EXPECT_NE(hashOf(other), hash);
    other = scene;
    other["materials"]["water"]["attenuation"] = {{"color", 0.5}, {"distance", 1}};
    EXPECT_NE(hashOf(other), hash);
}

TEST(Media, RefusesWhatMakesNoSense) {
    const auto refusal = [](const json& glassOf) {
        json scene = smallScene();
        scene["materials"]["water"] = glassOf;
        return errorOf(scene);
    };
    json thin = glass(1.5);
    thin["thin"] = true;
    thin["attenuation"] = {{"color", 0.5}, {"distance", 1}};
    EXPECT_NE(refusal(thin).find("/materials/water/attenuation"), std::string::npos);
    json abbe = glass(1.5);
    abbe["abbe"] = 0.5;
    EXPECT_NE(refusal(abbe).find("/materials/water/abbe"), std::string::npos);
    json far = glass(1.5);
    far["attenuation"] = {{"color", 2}, {"distance", 1}};
    EXPECT_NE(refusal(far).find("/materials/water/attenuation/color"), std::string::npos);
    json priority = glass(1.5);
    priority["priority"] = 1.5;
    EXPECT_NE(refusal(priority).find("/materials/water/priority"), std::string::npos);
}

} // namespace
} // namespace vkpm
