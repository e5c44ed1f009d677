/// Photons sent where the eye looks: the density over the numbers that start them, what is learned, the marks, and
/// pictures.
#include "judge.h"
#include "map_args.h"
#include "render/explain.h"
#include "render_support.h"
#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using Axes = std::array<bool, PRIMARY_DIMENSIONS>;
const Axes allAxes{true, true, true, true, true, true, true};

/// Starts with uniform numbers; what is useful and what it weighs, by number.
using Use = std::function<float(const PrimarySample&)>; // weight, or 0 if it is not seen

std::vector<PrimarySample> uniformStarts(uint count, uint seed) {
    Random random(seed);
    std::vector<PrimarySample> starts(count);
    for (PrimarySample& start : starts) {
        for (float& number : start.numbers) number = random.unit();
        start.inverseDensity = 1;
    }
    return starts;
}

std::vector<PrimarySample> judged(std::vector<PrimarySample> starts, const Use& use) {
    for (PrimarySample& start : starts) {
        const float weight = use(start);
        start.weight = weight > 0 ? weight : 1;
        start.seen = weight > 0;
        start.stored = 1;
    }
    return starts;
}

std::vector<PrimarySample> guided(const std::vector<GuideNode>& nodes, const std::vector<PrimarySample>& uniform) {
    const Buffer<PrimarySample> starts(testGpu(), "starts", uniform);
    const Buffer<GuideNode> guide(testGpu(), "guide", nodes);
    const Kernel<GuideStartArgs> kernel(testGpu(), "guide_start");
    Recording recording(testGpu());
    recording.run(kernel, uniform.size(), {starts, guide, static_cast<uint>(uniform.size())});
    recording.submit();
    return starts.download();
}

struct LeafBox {
    std::array<double, PRIMARY_DIMENSIONS> low{}, width{1, 1, 1, 1, 1, 1, 1};
    double probability = 1, volume = 1;

    bool holds(const PrimarySample& start) const {
        for (uint i = 0; i < PRIMARY_DIMENSIONS; i++)
            if (double(start.numbers[i]) < low[i] || double(start.numbers[i]) >= low[i] + width[i]) return false;
        return true;
    }
};

void collect(const std::vector<GuideNode>& nodes, uint node, LeafBox box, std::vector<LeafBox>& leaves) {
    const GuideNode& n = nodes[node];
    if (n.axis == NONE) return leaves.push_back(box);
    box.width[n.axis] /= 2;
    box.volume /= 2;
    LeafBox upper = box;
    upper.low[n.axis] += box.width[n.axis];
    box.probability *= double(n.lower);
    upper.probability *= 1 - double(n.lower);
    collect(nodes, n.child, box, leaves);
    collect(nodes, n.child + 1, upper, leaves);
}

std::vector<LeafBox> leavesOf(const std::vector<GuideNode>& nodes) {
    std::vector<LeafBox> leaves;
    collect(nodes, 0, {}, leaves);
    return leaves;
}

// Cuts three axes, one of them twice, to very different parts.
const std::vector<GuideNode> byHand{{4, 0.9f, 1}, {0, 0.3f, 3}, {6, 0.999f, 5}, {NONE, 0, 0}, {4, 0.25f, 7},
                                    {NONE, 0, 0}, {NONE, 0, 0}, {NONE, 0, 0},   {NONE, 0, 0}};

TEST(Guide, NumbersHaveTheDensityOfTheTree) {
    const uint count = 1u << 18;
    const std::vector<PrimarySample> starts = guided(byHand, uniformStarts(count, 1));
    double all = 0;
    for (const LeafBox& leaf : leavesOf(byHand)) {
        Mean mean, place;
        uint held = 0;
        for (const PrimarySample& start : starts) {
            if (!leaf.holds(start)) continue;
            held++;
            mean.add(double(start.inverseDensity) / (leaf.volume / leaf.probability));
            for (uint i = 0; i < PRIMARY_DIMENSIONS; i++)
                place.add((double(start.numbers[i]) - leaf.low[i]) / leaf.width[i]);
        }
        const double expected = count * leaf.probability;
        EXPECT_NEAR(held, expected, 5 * std::sqrt(expected * (1 - leaf.probability)));
        EXPECT_NEAR(mean.mean(), 1, 1e-5);
        EXPECT_NEAR(place.mean(), 0.5, 5 * std::sqrt(1 / 12.0 / held));
        all += leaf.volume;
    }
    EXPECT_EQ(all, 1);
}

// What is evenly spread along an axis stays in order, and in each leaf evenly spread.
TEST(Guide, EvenlySpreadNumbersStaySo) {
    std::vector<PrimarySample> line(1024);
    for (uint i = 0; i < line.size(); i++) {
        std::ranges::fill(line[i].numbers, 0.25f);
        line[i].numbers[4] = (float(i) + 0.5f) / float(line.size());
    }
    const std::vector<GuideNode> nodes{{4, 0.75f, 1}, {4, 0.125f, 3}, {NONE, 0, 0}, {NONE, 0, 0}, {NONE, 0, 0}};
    const std::vector<PrimarySample> starts = guided(nodes, line);
    for (uint i = 1; i < starts.size(); i++) {
        const float step = starts[i].numbers[4] - starts[i - 1].numbers[4];
        ASSERT_NEAR(step, (starts[i].inverseDensity + starts[i - 1].inverseDensity) / 2 / float(line.size()), 1e-5)
            << i;
        ASSERT_EQ(starts[i].numbers[3], 0.25f);
    }
}

// The largest number below one stays below one.
TEST(Guide, EndsOfTheUnitCube) {
    std::vector<PrimarySample> ends(2);
    std::ranges::fill(ends[1].numbers, 1 - 0x1p-24f);
    for (const PrimarySample& start : guided(byHand, ends))
        for (const float number : start.numbers) EXPECT_TRUE(number >= 0 && number < 1) << number;
}

GuideTree learned(const Use& use, uint count = 1u << 15, const Axes& axes = allAxes) {
    return guideTree(judged(uniformStarts(count, 3), use), axes);
}

TEST(Guide, LearnsABox) {
    const GuideTree tree = learned([](const PrimarySample& s) {
        return s.numbers[4] >= 0.25f && s.numbers[4] < 0.5f && s.numbers[6] >= 0.5f ? 1.0f : 0.0f;
    });
    EXPECT_NEAR(tree.gain, 8, 1);
    // Halves of a box in the middle are alike: the first cuts along either axis gain nothing.
    const GuideTree middle = learned([](const PrimarySample& s) {
        return std::abs(s.numbers[4] - 0.5f) < 0.25f && std::abs(s.numbers[5] - 0.5f) < 0.25f ? 1.0f : 0.0f;
    });
    EXPECT_NEAR(middle.gain, 4, 0.6);
}

TEST(Guide, AllOrNothingNeedsNoTree) {
    EXPECT_EQ(learned([](const PrimarySample&) { return 1.0f; }).nodes.size(), 1u);
    EXPECT_EQ(learned([](const PrimarySample&) { return 0.0f; }).nodes.size(), 1u);
    EXPECT_EQ(learned([](const PrimarySample&) { return 0.0f; }).gain, 1);
    EXPECT_EQ(guideTree({}, allAxes).nodes.size(), 1u);
}

// As many as the root of the mean square: twice as heavy, twice as many.
TEST(Guide, HeavyPhotonsAreMore) {
    const GuideTree tree = learned([](const PrimarySample& s) { return s.numbers[2] < 0.5f ? 2.0f : 1.0f; });
    ASSERT_EQ(tree.nodes.size(), 3u);
    EXPECT_EQ(tree.nodes[0].axis, 2u);
    EXPECT_NEAR(tree.nodes[0].lower, 2.0 / 3, 1e-3);
    EXPECT_NEAR(tree.gain, 2.5 / 2.25, 1e-3);
}

// Photons that cost nine times as much are a third as many, if all are seen; what costs little is not worth sparing.
TEST(Guide, CheapPhotonsAreMore) {
    const auto start = [](const PrimarySample& s) { return s.numbers[3] < 0.5f; };
    std::vector<PrimarySample> starts = judged(uniformStarts(1u << 15, 4), [](const PrimarySample&) { return 1.0f; });
    for (PrimarySample& s : starts) s.stored = start(s) ? 13 : 1; // 27 and 3
    const GuideTree tree = guideTree(starts, allAxes);
    ASSERT_EQ(tree.nodes.size(), 3u);
    EXPECT_EQ(tree.nodes[0].axis, 3u);
    EXPECT_NEAR(tree.nodes[0].lower, 0.25, 1e-3);
    EXPECT_NEAR(tree.gain, 1 * 15 / ((std::sqrt(27) + std::sqrt(3)) / 2 * (std::sqrt(27) + std::sqrt(3)) / 2), 1e-2);

    std::vector<PrimarySample> half =
        judged(uniformStarts(1u << 15, 4), [&](const PrimarySample& s) { return start(s) ? 1.0f : 0.0f; });
    const double dear = guideTree(half, allAxes).gain;
    for (PrimarySample& s : half) s.stored = start(s);
    const GuideTree cheap = guideTree(half, allAxes);
    EXPECT_NEAR(dear, 2, 0.1);
    EXPECT_NEAR(cheap.gain, 4.0 / 3, 0.1); // (1 / 2) (4 / 2) / (sqrt(3) / 2)^2
    EXPECT_NEAR(cheap.density, 2, 0.1);
}

TEST(Guide, OnlyAxesThatMatterAreCut) {
    Axes axes = allAxes;
    axes[0] = axes[6] = false;
    const auto use = [](const PrimarySample& s) { return s.numbers[0] < 0.5f && s.numbers[4] < 0.25f ? 1.0f : 0.0f; };
    for (const GuideNode& node : learned(use, 1u << 15, axes).nodes) EXPECT_TRUE(node.axis == NONE || axes[node.axis]);
    EXPECT_GT(learned(use).gain, 6);
    EXPECT_LT(learned(use, 1u << 15, axes).gain, 5);
}

// Photons that were guided before say the same of the useful ones as uniform ones do.
TEST(Guide, LearnsFromGuidedPhotons) {
    const Use use = [](const PrimarySample& s) { return s.numbers[4] < 0.25f && s.numbers[0] < 0.5f ? 1.0f : 0.0f; };
    const GuideTree uniform = learned(use, 1u << 16);
    const GuideTree again = guideTree(judged(guided(byHand, uniformStarts(1u << 16, 9)), use), allAxes);
    EXPECT_NEAR(again.gain / uniform.gain, 1, 0.15);
    EXPECT_NEAR(again.nodes[0].lower, uniform.nodes[0].lower, 0.05);
}

// One useful photon of two thousand: rounds find what it has in common with others.
TEST(Guide, RareOnesAreFoundInRounds) {
    const Use use = [](const PrimarySample& s) {
        return s.numbers[4] < 1 / 64.0f && s.numbers[5] < 1 / 32.0f ? 1.0f : 0.0f;
    };
    std::vector<PrimarySample> all = judged(uniformStarts(1u << 15, 5), use);
    GuideTree tree = guideTree(all, allAxes);
    for (uint round = 0; round < 2; round++) {
        const std::vector<PrimarySample> more = judged(guided(tree.nodes, uniformStarts(1u << 15, 6 + round)), use);
        all.insert(all.end(), more.begin(), more.end());
        tree = guideTree(all, allAxes);
    }
    const std::vector<PrimarySample> last = judged(guided(tree.nodes, uniformStarts(1u << 15, 8)), use);
    EXPECT_GT(std::ranges::count_if(last, [](const PrimarySample& s) { return s.seen > 0; }), (1 << 15) / 4);
}

// ---- In scenes ---------------------------------------------------------------------------------------------------

Settings smallSettings(const Scene& scene, bool guides) {
    Settings settings = scene.settings;
    settings.size = {32, 24};
    settings.photons = settings.causticPhotons = 10'000;
    settings.radius = 0.1f;
    settings.causticRadius = 0.02f;
    settings.guides = guides;
    return settings;
}

TEST(Marks, WhatTheEyeSeesIsMarked) {
    const Scene scene = ringCusp();
    const Settings settings = smallSettings(scene, true);
    const UploadedScene uploaded(testGpu(), scene, settings);
    const PhotonMap map{.radius = 0.01f};
    const CameraPilot places(testGpu(), uploaded, sceneFeatures(scene, settings), settings, {.caustic = map});

    // Where rays through the film meet the table, and the same places a room's width farther.
    Random random(2);
    const Camera camera = pinholeCamera(scene.view, settings.size);
    std::vector<Photon> photons;
    for (uint i = 0; i < 20'000; i++) {
        const vec3 direction =
            camera.forward + random.between(-1, 1) * camera.right + random.between(-1, 1) * camera.up;
        const vec3 place = camera.origin - direction * (camera.origin.y / direction.y);
        photons.push_back({i % 2 ? place + vec3(2, 0, 1) : place});
    }
    const Buffer<Photon> asked(testGpu(), "photons", photons);
    const Buffer<uint> marked(testGpu(), "marked", photons.size());
    const Kernel<IsMarkedArgs> kernel(testGpu(), "is_marked");
    Recording recording(testGpu());
    recording.run(
        kernel, photons.size(),
        {asked, places.marks.caustic.bits, marked, static_cast<uint>(photons.size()), places.marks.caustic.cellWidth});
    recording.submit();
    uint seen = 0, unseen = 0;
    for (uint i = 0; const uint is : marked.download()) (i++ % 2 ? unseen : seen) += is;
    EXPECT_GT(seen, 9'200u); // the ring hides a corner
    EXPECT_LT(unseen, 100u);
}

/// Means of a layer over the image, and over its pixels the variance between seeds.
struct Spread {
    Estimate mean;
    double variance = 0;
};

Spread spreadOf(const Scene& scene, const Settings& given, uint layer) {
    const uint seeds = 8;
    Settings settings = given;
    std::vector<double> means;
    std::vector<double> sums(settings.size.x * settings.size.y), squares(sums);
    for (uint seed = 0; seed < seeds; seed++) {
        settings.seed = seed;
        const std::vector<Pixel> pixels = renderPasses(scene, settings, 4).pixels;
        means.push_back(layerMean(pixels, layer));
        for (std::size_t i = 0; i < pixels.size(); i++) {
            const double value = double(pixels[i].mean.layers[layer].y);
            sums[i] += value, squares[i] += value * value;
        }
    }
    Spread spread{estimate(means)};
    for (std::size_t i = 0; i < sums.size(); i++)
        spread.variance += (squares[i] - sums[i] * sums[i] / seeds) / (seeds - 1);
    return spread;
}

// Radii are given, so that both have the same expectation.
void expectUnbiasedAndLessNoisy(const Scene& scene, uint layer, double part) {
    const Spread guided = spreadOf(scene, smallSettings(scene, true), layer);
    const Spread uniform = spreadOf(scene, smallSettings(scene, false), layer);
    EXPECT_NEAR(zScore(guided.mean, uniform.mean), 0, 4) << guided.mean.mean << " " << uniform.mean.mean;
    EXPECT_LT(guided.variance, uniform.variance * part);
}

TEST(Guide, CausticsNearbyAreUnbiasedAndLessNoisy) { expectUnbiasedAndLessNoisy(ringCusp(), LAYER_CAUSTIC, 0.5); }

/// One room of eight alike, each with a lamp.
Scene rooms() {
    nlohmann::json shapes = nlohmann::json::array();
    for (int room = 0; room < 8; room++) {
        const double x = 4 * room;
        const auto wall = [&](nlohmann::json corner, nlohmann::json u, nlohmann::json v) {
            corner[0] = corner[0].get<double>() + x;
            shapes.push_back({{"type", "rectangle"}, {"corner", corner}, {"edges", {u, v}}, {"material", "grey"}});
        };
        wall({0, 0, 0}, {2, 0, 0}, {0, 0, 2});
        wall({0, 2, 0}, {2, 0, 0}, {0, 0, 2});
        wall({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
        wall({0, 0, 2}, {2, 0, 0}, {0, 2, 0});
        wall({0, 0, 0}, {0, 2, 0}, {0, 0, 2});
        wall({2, 0, 0}, {0, 2, 0}, {0, 0, 2});
        shapes.push_back({{"type", "rectangle"},
                          {"corner", {x + 0.8, 1.99, 0.8}},
                          {"edges", {{0.4, 0, 0}, {0, 0, 0.4}}},
                          {"emission", 10}});
    }
    return loadJson({{"camera", {{"origin", {1, 1, 1.9}}, {"target", {1, 0.8, 0}}, {"fieldOfView", 60}}},
                     {"materials", {{"grey", {{"type", "diffuse"}, {"albedo", 0.6}}}}},
                     {"shapes", shapes}});
}

TEST(Guide, LampsOfOtherRoomsGetFewPhotons) { expectUnbiasedAndLessNoisy(rooms(), LAYER_INDIRECT, 0.7); }

TEST(Guide, LightSamplesGoWhereLightComesFrom) { expectUnbiasedAndLessNoisy(rooms(), LAYER_DIRECT, 0.5); }

/// A room with a window, and the sky and the sun outside; seen from within, or not at all.
Scene roomWithWindow(bool outside = false) {
    nlohmann::json shapes = nlohmann::json::array();
    const auto wall = [&](nlohmann::json corner, nlohmann::json u, nlohmann::json v) {
        shapes.push_back({{"type", "rectangle"}, {"corner", corner}, {"edges", {u, v}}, {"material", "grey"}});
    };
    wall({0, 0, 0}, {4, 0, 0}, {0, 0, 4});
    wall({0, 2, 0}, {4, 0, 0}, {0, 0, 4});
    wall({0, 0, 0}, {4, 0, 0}, {0, 2, 0});
    wall({0, 0, 4}, {4, 0, 0}, {0, 2, 0});
    wall({4, 0, 0}, {0, 2, 0}, {0, 0, 4});
    wall({0, 0, 0}, {0, 0.9, 0}, {0, 0, 4});
    wall({0, 1.7, 0}, {0, 0.3, 0}, {0, 0, 4});
    wall({0, 0.9, 0}, {0, 0.8, 0}, {0, 0, 1.5});
    wall({0, 0.9, 2.5}, {0, 0.8, 0}, {0, 0, 1.5});
    nlohmann::json camera{{"origin", {3.9, 1, 3.9}}, {"target", {1, 0.8, 0}}, {"fieldOfView", 70}};
    if (outside) camera["origin"] = {-1, 5, 0}, camera["target"] = {-2, 5, 0};
    return loadJson({{"camera", camera},
                     {"environment", {{"radiance", 1}}},
                     {"lights", {{{"type", "sun"}, {"direction", {-1, 0.7, 0.5}}, {"irradiance", 2}}}},
                     {"materials", {{"grey", {{"type", "diffuse"}, {"albedo", 0.6}}}}},
                     {"shapes", shapes}});
}

TEST(Guide, SkySamplesGoThroughTheWindow) { expectUnbiasedAndLessNoisy(roomWithWindow(), LAYER_DIRECT, 0.4); }

// Two regions, left and right of x = 0, with a tree each. A direction says which factor its numbers had; numbers at the
// edge of a box may round to either side.
TEST(Guide, DirectionsOfTheSkyKnowTheirDensity) {
    const std::vector<GuideNode> nodes{{0, 0, 1},
                                       {LIGHT_GUIDE_REGION, 2, 3},
                                       {LIGHT_GUIDE_REGION, 4, 8},
                                       {0, 0.7f, 4},
                                       {1, 0.2f, 6},
                                       {NONE, 0, 0},
                                       {NONE, 0, 0},
                                       {NONE, 0, 0},
                                       {1, 0.9f, 9},
                                       {0, 0.4f, 11},
                                       {NONE, 0, 0},
                                       {NONE, 0, 0},
                                       {NONE, 0, 0}};
    const uint count = 1u << 16;
    Random random(11);
    std::vector<VectorPair> cases(count);
    for (uint i = 0; i < count; i++) cases[i] = {{random.between(-1, 1), 0, 0}, {random.unit(), random.unit(), 0}};
    for (const Scene& scene : {roomWithWindow(), shippedScene("window_room")}) {
        UploadedScene uploaded(testGpu(), scene, smallSettings(scene, true));
        uploaded.guideLights(testGpu(), nodes);
        const Buffer<VectorPair> xs(testGpu(), "xs", cases), ys(testGpu(), "ys", count);
        const Kernel<MapArgs> kernel(testGpu(), "guided_sky");
        Recording recording(testGpu());
        recording.run(kernel, count, {{xs.address}, {ys.address}, uploaded.address, {}, count});
        recording.submit();
        Mean all;
        uint off = 0, i = 0;
        for (const VectorPair& found : ys.download()) {
            ASSERT_EQ(found.a.z, cases[i++].a.x < 0 ? 2 : 4);
            all.add(double(found.a.x));
            off += std::abs(found.a.x - found.a.y) > 1e-5f * found.a.x;
        }
        EXPECT_NEAR(all.mean(), 1, 0.03); // 4 standard errors
        EXPECT_LE(off, count / 2000);
    }
}

TEST(Guide, FeatureTellsWhetherThereIsOne) {
    const auto guides = [](const Scene& scene, bool wanted) {
        Renderer renderer(testGpu(), scene, smallSettings(scene, wanted));
        renderer.renderPass(0);
        return renderer.features().hasGuide;
    };
    EXPECT_EQ(guides(ringCusp(), true), 1u);
    EXPECT_EQ(guides(ringCusp(), false), 0u);
    EXPECT_EQ(guides(shippedScene("diffuse_box"), true), 0u);
}

TEST(Guide, PlanSaysWhetherSkySamplesHaveOne) {
    const auto reason = [](const Features& features, const Settings& settings) {
        for (const FeatureReason& line : explainFeatures(features, settings))
            if (line.name == "hasLightGuide") return line.reason;
        return std::string();
    };
    const auto rendered = [&](const Scene& scene, bool wanted) {
        const Settings settings = smallSettings(scene, wanted);
        Renderer renderer(testGpu(), scene, settings);
        renderer.renderPass(0);
        return reason(renderer.features(), settings);
    };
    EXPECT_EQ(rendered(roomWithWindow(), true), "light samples go where the sky comes in, by region");
    EXPECT_EQ(rendered(roomWithWindow(true), true),
              "most of the sky reaches what the eye sees, or it is not known yet");
    EXPECT_EQ(rendered(roomWithWindow(), false), "guides were not asked for");
    const Scene box = shippedScene("diffuse_box");
    EXPECT_EQ(reason(sceneFeatures(box, smallSettings(box, true)), smallSettings(box, true)),
              "the scene has no light from a sky");
}

} // namespace
} // namespace vkpm
