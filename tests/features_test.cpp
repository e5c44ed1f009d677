/// The program that is compiled for a scene renders the bits of the general one: on the shipped scenes and on random
/// ones.
#include "draw.h"
#include "judge.h"
#include "render_support.h"
#include "shared_layers.h"
#include "shared_photons.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace vkpm {
namespace {

using nlohmann::json;

std::vector<Pixel> renderWith(const Scene& scene, Settings settings, bool allFeatures) {
    settings.allFeatures = allFeatures;
    return renderPasses(scene, settings, 2).pixels;
}

// Returns the mean of beauty.
double expectSameBits(const Scene& scene, const Settings& settings, const std::string& what) {
    const std::vector<Pixel> special = renderWith(scene, settings, false);
    const std::vector<Pixel> general = renderWith(scene, settings, true);
    EXPECT_EQ(special.size(), general.size());
    EXPECT_EQ(std::memcmp(special.data(), general.data(), special.size() * sizeof(Pixel)), 0) << what;
    return layerMean(special, LAYER_COUNT);
}

TEST(Features, ShippedScenesRenderTheSameBits) {
    uint index = 0;
    for (const char* name : {"box", "diffuse_box", "ring", "glass", "pool"}) {
        if (!isDrawn(index++)) continue; // half of them with each commit
        const Scene scene = shippedScene(name);
        Settings settings = scene.settings;
        settings.size = {24, 16};
        settings.photons = settings.causticPhotons = 1000;
        for (const uint integrator :
             {INTEGRATOR_PHOTON, INTEGRATOR_PATH, INTEGRATOR_DIRECT, INTEGRATOR_PHOTON_MAP, INTEGRATOR_LIGHT}) {
            settings.integrator = integrator;
            expectSameBits(scene, settings, name);
        }
    }
}

// Layers that somebody asked for are those of a render of all, and the others are black.
TEST(Features, LayersAskedForAreThoseOfTheWhole) {
    for (const char* name : {"box", "pool"})
        for (const uint integrator : {INTEGRATOR_PHOTON, INTEGRATOR_PATH, INTEGRATOR_LIGHT}) {
            const Scene scene = shippedScene(name);
            Settings settings = scene.settings;
            settings.size = {24, 16};
            settings.photons = settings.causticPhotons = 1000;
            settings.integrator = integrator;
            const std::vector<Pixel> whole = renderWith(scene, settings, false);
            for (const uint layers :
                 {1u << LAYER_CAUSTIC, 1u << LAYER_INDIRECT, 1u << LAYER_SPECULAR, 1u << LAYER_DIRECT,
                  1u << LAYER_EMISSION | 1u << LAYER_CAUSTIC, 1u << ASK_ALBEDO | 1u << ASK_DEPTH}) {
                settings.layers = layers;
                const std::vector<Pixel> part = renderWith(scene, settings, false);
                for (std::size_t i = 0; i < whole.size(); i++) {
                    for (uint layer = 0; layer < LAYER_COUNT; layer++)
                        ASSERT_EQ(part[i].mean.layers[layer],
                                  layers >> layer & 1 ? whole[i].mean.layers[layer] : vec3(0))
                            << name << " " << layer;
                    ASSERT_EQ(part[i].mean.albedo, layers >> ASK_ALBEDO & 1 ? whole[i].mean.albedo : vec3(0));
                    ASSERT_EQ(part[i].mean.depth, layers >> ASK_DEPTH & 1 ? whole[i].mean.depth : 0);
                }
            }
        }
}

// Many photons: what one in a million meets, such as a grazing hit, is in few pictures.
TEST(Features, ShippedScenesEmitTheSamePhotons) {
    const uint count = isNightly() ? 2'000'000 : 300'000;
    uint index = 0;
    for (const char* name : {"box", "ring", "glass", "pool"}) {
        if (!isDrawn(index++)) continue;
        const Scene scene = shippedScene(name);
        Settings general = scene.settings;
        general.allFeatures = true;
        const UploadedScene uploaded(testGpu(), scene, general);
        const auto trace = [&](MapKind kind, const Settings& settings) {
            PhotonTracing tracing(testGpu(), uploaded, sceneFeatures(scene, settings), kind, count, 0, 1u << 17);
            const PhotonLedger ledger = tracing.trace(11);
            return tracing.photons.download(ledger.stored);
        };
        for (const MapKind kind : {MapKind::global, MapKind::caustic}) {
            const std::vector<Photon> special = trace(kind, scene.settings), all = trace(kind, general);
            ASSERT_EQ(special.size(), all.size()) << name;
            EXPECT_EQ(std::memcmp(special.data(), all.data(), all.size() * sizeof(Photon)), 0) << name;
        }
    }
}

// Renders a pass without a feature that the scene needs, with checks.
void renderWithout(const Scene& scene, const std::function<void(Features&)>& leaveOut) {
    Settings settings = scene.settings;
    settings.size = {64, 64};
    settings.photons = settings.causticPhotons = 5000;
    Features features = sceneFeatures(scene, settings);
    features.checksFeatures = 1;
    leaveOut(features);
    Renderer(testGpu(), scene, settings, features).renderPass(0);
}

void expectMissed(const Scene& scene, const std::string& label, const std::function<void(Features&)>& leaveOut) {
    try {
        renderWithout(scene, leaveOut);
        ADD_FAILURE() << scene.name << " renders without " << label;
    } catch (const std::logic_error& error) {
        EXPECT_NE(std::string(error.what()).find(label), std::string::npos) << error.what();
    }
}

TEST(Features, LeavingOutWhatASceneNeedsIsFoundOut) {
    for (const char* name : {"box", "glass", "pool"}) {
        if (name == std::string("pool") && !isThorough()) continue; // has what the others have
        const Scene scene = shippedScene(name);
        const Features has = sceneFeatures(scene, scene.settings);
        EXPECT_NO_THROW(renderWithout(scene, [](Features&) {})) << name;
        uint tried = 0;
        for (const auto& [label, feature] : std::initializer_list<std::pair<const char*, bool Features::*>>{
                 {"hasTriangles", &Features::hasTriangles},
                 {"hasSpheres", &Features::hasSpheres},
                 {"hasSmoothNormals", &Features::hasSmoothNormals},
                 {"hasSmoothDiffuse", &Features::hasSmoothDiffuse},
                 {"hasTint", &Features::hasTint},
                 {"hasExactFresnel", &Features::hasExactFresnel},
                 {"hasManyLights", &Features::hasManyLights},
                 {"hasTwoSidedLights", &Features::hasTwoSidedLights}}) {
            if (!(has.*feature)) continue;
            tried++;
            expectMissed(scene, label, [&](Features& features) { features.*feature = false; });
        }
        for (uint bit = 1; bit != 0; bit <<= 1) {
            if ((has.materialKinds & bit) != 0)
                expectMissed(scene, "materialKinds", [&](Features& features) { features.materialKinds &= ~bit; });
            if ((has.lightKinds & bit) != 0)
                expectMissed(scene, "lightKinds", [&](Features& features) { features.lightKinds &= ~bit; });
        }
        EXPECT_GE(tried, 3u) << name;
    }
}

// A lamp of the size and distance of the sun.
TEST(Features, FarLightsAreMissed) {
    const Scene scene = loadJson(json::parse(
        R"({"camera": {"origin": [0, 1, 3], "target": [0, 0, 0]}, "materials": {"grey": {"type": "diffuse", "albedo": 0.5}},
        "shapes": [{"type": "rectangle", "corner": [-1, 0, 1], "edges": [[2, 0, 0], [0, 0, -2]], "material": "grey"},
                   {"type": "sphere", "center": [0, 100, 0], "radius": 0.5, "emission": 1}]})"));
    EXPECT_NO_THROW(renderWithout(scene, [](Features&) {}));
    EXPECT_THROW(renderWithout(scene, [](Features& features) { features.hasFarLights = 0; }), std::logic_error);
}

// A scene of a few shapes in a room or in the open, drawn from everything that a scene file can say.
class Generator {
public:
    explicit Generator(uint seed) : random(seed) {}

    json scene() {
        materials = {{"white", {{"type", "diffuse"}, {"albedo", color(0, 1)}}}};
        if (maybe()) materials["grey"] = {{"type", "diffuse"}, {"albedo", random.unit()}};
        if (maybe()) materials["steel"] = {{"type", "mirror"}, {"reflectance", color(0.5f, 1)}};
        if (maybe()) materials["glass"] = {{"type", "glass"}, {"ior", random.between(1.0f, 2.5f)}};
        if (materials.contains("glass") && maybe()) materials["glass"]["tint"] = color(0, 1);
        if (random.bits() % 3 == 0) {
            const json image = {{"texture", std::string(VKPM_SCENES) + "/wood.png"}};
            materials["wood"] = {
                {"type", "standard"}, {"metallic", random.unit()}, {"baseColor", image}, {"roughness", image}};
            if (maybe()) materials["wood"]["transmission"] = maybe() ? image : json(random.unit());
            if (maybe()) materials["white"]["albedo"] = image;
        }
        if (random.bits() % 4 == 0)
            materials[maybe() ? "white" : "veil"] = {{"type", "diffuse"}, {"albedo", 0.7}, {"opacity", random.unit()}};
        if (random.bits() % 3 == 0) {
            materials["lacquer"] = {{"type", "plastic"}, {"albedo", color(0, 1)}, {"roughness", random.unit()}};
            if (maybe()) materials["lacquer"]["normalMap"] = {{"texture", std::string(VKPM_SCENES) + "/wood.png"}};
        }
        shapes = json::array();
        const bool onlySpheres = random.bits() % 6 == 0;
        if (!onlySpheres && maybe()) room();
        for (uint i = 0, n = 1 + random.bits() % 4; i < n; i++)
            shapes.push_back(onlySpheres || maybe() ? sphere() : maybe() ? rectangle() : mesh());
        for (uint i = 0, n = 1 + random.bits() % 3; i < n; i++) shapes.push_back(light(onlySpheres));
        return {{"camera",
                 {{"origin", {random.between(-0.2f, 0.2f), 0.1, 0.9}},
                  {"target", {0, 0, 0}},
                  {"fieldOfView", random.between(30, 100)}}},
                {"materials", materials},
                {"shapes", shapes}};
    }

    Settings settings() {
        Settings s;
        s.size = {12, 8};
        s.photons = random.bits() % 8 ? 300 : 0;
        s.causticPhotons = random.bits() % 8 ? 300 : 0;
        s.gatherRays = 1 + random.bits() % 3;
        s.pixelSamples = 1 + random.bits() % 3;
        s.integrator = random.bits() % 2 ? INTEGRATOR_PHOTON : random.bits() % 5;
        s.kernel = random.bits() % 4;
        s.schlick = maybe();
        s.nearest = random.bits() % 4 ? 0 : 1 + random.bits() % 20;
        s.showCaustic = maybe();
        s.showPoints = s.integrator == INTEGRATOR_PHOTON_MAP && maybe();
        s.seed = random.bits();
        if (random.bits() % 4 == 0) s.layers = 1 + random.bits() % allLayers;
        if (maybe()) s.radius = random.between(0.01f, 0.3f);
        if (maybe()) s.causticRadius = random.between(0.01f, 0.3f);
        return s;
    }

private:
    bool maybe() { return random.bits() % 2 == 0; }
    json color(float low, float high) {
        return {random.between(low, high), random.between(low, high), random.between(low, high)};
    }
    json vector(float half) {
        return {random.between(-half, half), random.between(-half, half), random.between(-half, half)};
    }
    std::string material() {
        auto chosen = materials.begin();
        std::advance(chosen, random.bits() % materials.size());
        return chosen.key();
    }

    json sphere() {
        return {{"type", "sphere"},
                {"center", vector(0.6f)},
                {"radius", random.between(0.05f, 0.4f)},
                {"material", material()}};
    }
    json rectangle() {
        return {{"type", "rectangle"},
                {"corner", vector(0.8f)},
                {"edges",
                 {{random.between(0.2f, 1), random.between(-0.3f, 0.3f), 0}, {0, random.between(-0.3f, 0.3f), -0.5}}},
                {"material", material()}};
    }
    json mesh() {
        return {{"type", "mesh"},
                {"file", std::string(VKPM_SCENES) + (maybe() ? "/ring.obj" : "/knot.obj")},
                {"material", material()},
                {"transform", {{{"scale", 0.1}}, {{"translate", vector(0.5f)}}}}};
    }
    json light(bool onlySpheres) {
        json shape = onlySpheres || maybe() ? sphere() : rectangle();
        shape.erase("material");
        shape["emission"] = color(0, 20);
        if (maybe() && !materials["white"].contains("opacity")) shape["material"] = "white";
        if (random.bits() % 4 == 0)
            shape["emission"] = {{"texture", std::string(VKPM_SCENES) + "/sunset.png"}, {"factor", 9}};
        if (maybe()) shape["twoSided"] = true;
        if (random.bits() % 4 == 0) shape["transform"] = {{{"translate", vector(50)}}};
        return shape;
    }
    void room() {
        for (int axis = 0; axis < 3; axis++)
            for (const int side : {-1, 1}) {
                json corner{-1, -1, -1}, u{0, 0, 0}, v{0, 0, 0};
                corner[axis] = side;
                u[(axis + 1) % 3] = 2;
                v[(axis + 2) % 3] = 2;
                shapes.push_back(
                    {{"type", "rectangle"}, {"corner", corner}, {"edges", {u, v}}, {"material", material()}});
            }
    }

    Random random;
    json materials;
    json shapes;
};

/// A random scene with its settings, and which values of features occur in it together.
struct RandomScene {
    uint seed;
    json text;
    Settings settings;
    std::set<std::array<uint, 4>> pairs{}; // feature, its value, another feature, its value
};

RandomScene randomScene(uint seed) {
    Generator generator(seed);
    RandomScene random{seed, generator.scene()};
    random.settings = generator.settings();
    std::vector<std::array<uint, 2>> values;
    const Features features = sceneFeatures(loadJson(random.text), random.settings);
#define X(id, type, name, value)                                                                                       \
    if (id != id_stackSize && id != id_checksFeatures && id != id_hasLabels)                                           \
        values.push_back({id, uint(features.name)});
    FEATURES(X)
#undef X
    for (const auto& [a, va] : values)
        for (const auto& [b, vb] : values)
            if (a < b) random.pairs.insert({a, va, b, vb});
    return random;
}

/// Moves to the front the scenes that have all pairs between them, each the one with most that are still missing;
/// returns how many.
std::size_t coverFirst(std::vector<RandomScene>& scenes) {
    std::set<std::array<uint, 4>> had;
    for (std::size_t chosen = 0; chosen < scenes.size(); chosen++) {
        const auto adds = [&](const RandomScene& scene) {
            return std::ranges::count_if(scene.pairs, [&](const auto& pair) { return !had.contains(pair); });
        };
        const auto best = std::ranges::max_element(scenes.begin() + std::ptrdiff_t(chosen), scenes.end(), {}, adds);
        if (adds(*best) == 0) return chosen;
        had.insert(best->pairs.begin(), best->pairs.end());
        std::rotate(scenes.begin() + std::ptrdiff_t(chosen), best, best + 1);
    }
    return scenes.size();
}

// Features act on each other in pairs: scenes that have all pairs of 240 between them, and some more, drawn anew with
// each commit.
TEST(Features, RandomScenesRenderTheSameBits) {
    std::vector<RandomScene> scenes;
    for (uint seed = 0; seed < 240; seed++) scenes.push_back(randomScene(seed));
    const std::size_t cover = coverFirst(scenes);
    std::shuffle(scenes.begin() + std::ptrdiff_t(cover), scenes.end(), std::mt19937(drawSeed()));
    if (!isNightly()) scenes.resize(std::min(cover + 2, scenes.size()));
    uint lit = 0, index = 0;
    const uint commits = isThorough() ? 16 : 40; // until all pairs have been
    std::erase_if(scenes, [&](const RandomScene&) { return !isDrawn(index++, commits); });
    for (const RandomScene& scene : scenes)
        lit += expectSameBits(loadJson(scene.text), scene.settings,
                              "seed " + std::to_string(scene.seed) + ": " + scene.text.dump()) > 1e-4;
    std::printf("%zu scenes have all pairs; of %zu rendered, %u are lit\n", cover, scenes.size(), lit);
    if (scenes.size() > 30) EXPECT_GT(lit, scenes.size() / 3); // of fewer it says nothing
}

} // namespace
} // namespace vkpm
