/// Renders with results in closed form: furnace, photon ledger, form factors, plates, and exact symmetries.
#include "render_support.h"
#include "shared_layers.h"
#include "shared_photons.h"
#include <cstring>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpm {
namespace {

using nlohmann::json;

json box(double low, double high, const char* material) {
    json faces = json::array();
    const double size = high - low;
    for (int axis = 0; axis < 3; axis++)
        for (const bool upper : {false, true}) {
            json corner{low, low, low};
            json u{0, 0, 0};
            json v{0, 0, 0};
            corner[axis] = upper ? high : low;
            u[(axis + 1) % 3] = size;
            v[(axis + 2) % 3] = size;
            faces.push_back({{"type", "rectangle"},
                             {"corner", corner},
                             {"edges", {upper ? v : u, upper ? u : v}},
                             {"material", material}});
        }
    return faces;
}

json cameraAt(json origin, json target, double degrees) {
    return {{"origin", origin}, {"target", target}, {"up", {0, 1, 0.001}}, {"fieldOfView", degrees}};
}

json furnace(double albedo, double emission) {
    return {{"camera", cameraAt({0, 0, 0}, {0, 0, -1}, 60)},
            {"film", {{"size", {16, 16}}}},
            {"materials", {{"wall", {{"type", "diffuse"}, {"albedo", albedo}}}}},
            {"shapes",
             {{{"type", "sphere"},
               {"center", {0, 0, 0}},
               {"radius", 1},
               {"material", "wall"},
               {"emission", emission},
               {"twoSided", true}}}}};
}

// A sphere that emits E and reflects a everywhere: radiance E / (1 - a) in every direction, from each of its parts.
void expectFurnace(uint integrator, double tolerance) {
    Settings settings{.size = {16, 16}, .photons = 100'000};
    settings.integrator = integrator;
    settings.radius = 0.05f;
    const Rendered image = renderPasses(loadJson(furnace(0.5, 0.5)), settings, 64);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_EMISSION), 0.5, 1e-6);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_DIRECT), 0.25, 0.25 * tolerance);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_INDIRECT), 0.25, 0.25 * tolerance);
    EXPECT_EQ(image.nonfinite, 0u);
}

// 16,384 samples with a relative deviation of about 1: five standard errors are 4 %; the mean over pixels does far
// better.
TEST(Furnace, PathTracerFindsTheClosedForm) { expectFurnace(INTEGRATOR_PATH, 0.02); }

// The tangent disc misses photons of a curved wall beyond (r / R)^2 / 4; r is a twentieth.
TEST(Furnace, PhotonMapFindsTheClosedForm) { expectFurnace(INTEGRATOR_PHOTON, 0.02); }

json lampRoom(double albedo) {
    json shapes = box(-1, 1, "wall");
    shapes.push_back(
        {{"type", "rectangle"}, {"corner", {-0.2, 0.5, -0.2}}, {"edges", {{0.4, 0, 0}, {0, 0, 0.4}}}, {"emission", 1}});
    return {{"camera", cameraAt({0, 0, 0.9}, {0, 0, 0}, 40)},
            {"film", {{"size", {8, 8}}}},
            {"materials", {{"wall", {{"type", "diffuse"}, {"albedo", albedo}}}}},
            {"shapes", shapes}};
}

PhotonLedger ledgerOf(const json& scene, uint photons) {
    Settings settings{.size = {8, 8}, .photons = photons};
    return renderPasses(loadJson(scene), settings, 1).global;
}

// A closed room absorbs all; only the lamp's black back takes photons early.
TEST(PhotonLedger, ClosedRoomBalances) {
    for (const double albedo : {0.0, 0.5, 0.9, 0.99}) {
        const PhotonLedger ledger = ledgerOf(lampRoom(albedo), 20'000);
        EXPECT_EQ(ledger.emitted, 20'000u);
        EXPECT_EQ(ledger.emitted, ledger.absorbed + ledger.escaped + ledger.lost) << albedo;
        EXPECT_EQ(ledger.escaped, 0u) << albedo;
        EXPECT_EQ(ledger.lost, 0u) << albedo;
    }
}

// Deposits of a photon are geometric: mean 1 / (1 - a), variance a / (1 - a)^2. The light stands on a wall that
// reflects, so nothing is black: a sphere that emits inwards and reflects a.
TEST(PhotonLedger, StoredFluxIsTheGeometricSeries) {
    for (const double albedo : {0.5, 0.9, 0.99}) {
        json scene = furnace(albedo, 1);
        const PhotonLedger ledger = ledgerOf(scene, 100'000);
        const double inside = double(ledger.emitted - ledger.escaped); // the other half leaves outwards
        const double expected = inside / (1 - albedo);
        EXPECT_NEAR(inside, 50'000, 5 * std::sqrt(25'000.0));
        EXPECT_NEAR(double(ledger.stored), expected, 5 * std::sqrt(inside * albedo) / (1 - albedo)) << albedo;
    }
}

json rectangle(json corner, json u, json v) { return {{"type", "rectangle"}, {"corner", corner}, {"edges", {u, v}}}; }

// Fraction of a lamp's flux that arrives at a black receiver. Photons of a lamp far away are aimed at it, and weigh
// less.
double formFactor(json lamp, json receiver, uint photons) {
    lamp["emission"] = 1;
    receiver["material"] = "black";
    const json scene{{"camera", cameraAt({0, 5, 5}, {0, 0, 0}, 30)},
                     {"film", {{"size", {4, 4}}}},
                     {"materials", {{"black", {{"type", "diffuse"}, {"albedo", 0}}}}},
                     {"shapes", {receiver, lamp}}};
    const Scene loaded = loadJson(scene);
    const UploadedScene uploaded(testGpu(), loaded, loaded.settings);
    PhotonTracing tracing(testGpu(), uploaded, sceneFeatures(loaded, loaded.settings), MapKind::global, photons, 0,
                          1u << 17);
    const PhotonLedger ledger = tracing.trace(0);
    EXPECT_EQ(ledger.emitted, ledger.absorbed + ledger.escaped + ledger.lost);
    double flux = 0;
    for (const Photon& photon : tracing.photons.download(ledger.stored)) flux += double(photon.color.y);
    return flux / double(ledger.emitted);
}

TEST(FormFactor, FacingSquares) {
    const uint photons = 1'000'000;
    for (const auto& [distance, expected] : {std::pair{1.0, 0.1998248957}, {0.1, 0.8269945224}, {10.0, 0.0031620568}}) {
        const double found = formFactor(rectangle({0, distance, 0}, {1, 0, 0}, {0, 0, 1}),
                                        rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), photons);
        EXPECT_NEAR(found, expected, 5 * std::sqrt(expected * (1 - expected) / photons)) << distance;
    }
}

TEST(FormFactor, PerpendicularSquares) {
    const double expected = 0.2000437761;
    const double found =
        formFactor(rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1'000'000);
    EXPECT_NEAR(found, expected, 5 * std::sqrt(expected * (1 - expected) / 1e6));
}

// Irradiance under the centre of a unit light, by light samples and by photons.
json floorUnderLamp(double height) {
    json floor = rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    floor["material"] = "white";
    json lamp = rectangle({-0.5, height, -0.5}, {1, 0, 0}, {0, 0, 1});
    lamp["emission"] = 1;
    return {{"camera", cameraAt({0, 0.5 * height, 0.0001}, {0, 0, 0}, 0.5)},
            {"film", {{"size", {16, 16}}}},
            {"materials", {{"white", {{"type", "diffuse"}, {"albedo", 1}}}}},
            {"shapes", {floor, lamp}}};
}

TEST(Irradiance, UnderASquareLamp) {
    Settings settings{.size = {16, 16}};
    settings.integrator = INTEGRATOR_DIRECT;
    const Rendered image = renderPasses(loadJson(floorUnderLamp(1)), settings, 64);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_DIRECT) * std::numbers::pi, 0.7522746885, 0.7522746885 * 0.003);
}

TEST(Irradiance, OfThePhotonMapUnderASquareLamp) {
    Settings settings{.size = {16, 16}, .photons = 2'000'000};
    settings.integrator = INTEGRATOR_PHOTON_MAP;
    for (const uint kernel :
         {DENSITY_KERNEL_CONSTANT, DENSITY_KERNEL_CONE, DENSITY_KERNEL_GAUSS, DENSITY_KERNEL_EPANECHNIKOV}) {
        settings.kernel = kernel;
        settings.radius = 0.05f; // some 3,700 photons; bias below 0.1 %
        const Rendered image = renderPasses(loadJson(floorUnderLamp(1)), settings, 1);
        EXPECT_NEAR(layerMean(image.pixels, LAYER_INDIRECT) * std::numbers::pi, 0.7522746885,
                    0.7522746885 * 5 * std::sqrt(1.34 / 3700))
            << kernel;
    }
    settings.kernel = DENSITY_KERNEL_CONSTANT;
    settings.nearest = 2000;
    const Rendered image = renderPasses(loadJson(floorUnderLamp(1)), settings, 1);
    EXPECT_NEAR(layerMean(image.pixels, LAYER_INDIRECT) * std::numbers::pi, 0.7522746885,
                0.7522746885 * 5 / std::sqrt(2000.0));
}

// A lamp seen straight through a lossless plate of index 1.5, with all inner reflections.
TEST(Glass, PlateTransmits) {
    json shapes = json::array(
        {rectangle({-5, -5, -0.05}, {0, 10, 0}, {10, 0, 0}), rectangle({-5, -5, 0.05}, {10, 0, 0}, {0, 10, 0})});
    for (json& face : shapes) face["material"] = "glass";
    json lamp = rectangle({-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
    lamp["emission"] = 1;
    shapes.push_back(lamp);
    const json scene{{"camera", cameraAt({0, 0, 3}, {0, 0, 0}, 2)},
                     {"film", {{"size", {32, 32}}}},
                     {"materials", {{"glass", {{"type", "glass"}, {"ior", 1.5}}}}},
                     {"shapes", shapes}};
    Settings settings{.size = {32, 32}};
    settings.integrator = INTEGRATOR_DIRECT;
    const uint passes = 64;
    const Rendered image = renderPasses(loadJson(scene), settings, passes);
    // Each sample is 0 or 1.
    EXPECT_NEAR(layerMean(image.pixels, LAYER_SPECULAR), 0.9230769,
                5 * std::sqrt(0.923 * 0.077 / (32.0 * 32 * passes)));
}

TEST(Determinism, TwoRunsGiveTheSameBits) {
    const Scene scene = shippedScene("box");
    Settings settings = scene.settings;
    settings.size = {64, 64};
    settings.photons = settings.causticPhotons = 20'000;
    const Rendered first = renderPasses(scene, settings, 2);
    const Rendered second = renderPasses(scene, settings, 2);
    EXPECT_EQ(std::memcmp(first.pixels.data(), second.pixels.data(), first.pixels.size() * sizeof(Pixel)), 0);
    settings.seed = 1;
    const Rendered other = renderPasses(scene, settings, 2);
    EXPECT_NE(std::memcmp(first.pixels.data(), other.pixels.data(), first.pixels.size() * sizeof(Pixel)), 0);
}

// The box, its camera and its light, larger by a factor; radiance does not change.
Scene scaledBox(float factor) {
    json scene = json::parse(std::ifstream(std::filesystem::path(VKPM_SCENES) / "box.json"));
    scene.erase("$schema");
    for (const char* key : {"origin", "target"})
        for (json& x : scene["camera"][key]) x = x.get<float>() * factor;
    for (json& shape : scene["shapes"]) shape["transform"].push_back({{"scale", factor}});
    return loadJson(scene);
}

TEST(Scale, APowerOfTwoChangesNoBitOfTheRadiance) {
    Settings settings{.size = {64, 64}, .photons = 20'000, .causticPhotons = 20'000};
    for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_LIGHT}) {
        settings.integrator = integrator;
        const Rendered tame = renderPasses(scaledBox(1), settings, 1);
        for (const float factor : {0x1p-10f, 0x1p12f}) {
            const Rendered scaled = renderPasses(scaledBox(factor), settings, 1);
            std::size_t differ = 0;
            for (std::size_t i = 0; i < tame.pixels.size(); i++)
                differ += std::memcmp(&tame.pixels[i].mean.layers, &scaled.pixels[i].mean.layers,
                                      sizeof(tame.pixels[i].mean.layers)) != 0;
            EXPECT_EQ(differ, 0u) << integrator << ", " << factor;
        }
    }
}

} // namespace
} // namespace vkpm
