/// Glossy lobes: samples against densities, values against albedos of quadratures, and both ways alike.
#include "judge.h"
#include "map.h"
#include "scene/rest.h"
#include "scene_on_device.h"
#include <gtest/gtest.h>
#include <numeric>

namespace vkpm {
namespace {

Material metal(double alpha, vec3 reflectance = vec3{1}) {
    return {MATERIAL_METAL, reflectance, 1, 0, static_cast<float>(alpha), NONE};
}

Material plastic(double alpha) { return {MATERIAL_PLASTIC, vec3{0.5f}, 1.5f, 0, static_cast<float>(alpha), NONE}; }

/// With its two rows, of which tests put the first at 0.
Material standard(double alpha, float metallic, vec3 base = vec3{1}, vec3 normalIncidence = vec3{0.04f},
                  float grazing = 1) {
    return {MATERIAL_STANDARD, base, 1.5f, 0, static_cast<float>(alpha), 0, normalIncidence, grazing, metallic};
}

vec3 direction(double z, double turns) {
    const double r = std::sqrt(1 - z * z);
    return vec3{glm::dvec3{r * std::cos(2 * pi * turns), r * std::sin(2 * pi * turns), z}};
}

/// Samples of light that comes at a cosine, by numbers on a grid.
void addGrid(std::vector<GlossyCase>& xs, const Material& material, double cosine, int side) {
    for (int i = 0; i < side * side; i++)
        xs.push_back({material,
                      direction(cosine, 0.1),
                      {0, 0, 1},
                      {(float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side)}});
}

double albedo(const std::vector<float>& row, double cosine) {
    const double x = std::sqrt(cosine) * REST_STEPS;
    const auto i = std::min(static_cast<std::size_t>(x), std::size_t{REST_STEPS - 1});
    return 1 - std::lerp(double{row[i]}, double{row[i + 1]}, x - double(i));
}

// Single reflections by perfect facets, in double precision from an independent quadrature; at normal incidence and
// alpha = 1 it is 1 - ln 2.
TEST(Glossy, AlbedosOfSingleReflections) {
    const double cosines[]{1, 0.7, 0.5, 0.3, 0.1};
    const std::pair<double, std::vector<double>> known[]{{0.1, {0.9883, 0.9814, 0.9692, 0.9363, 0.8834, 0.9720}},
                                                         {0.3, {0.8774, 0.8445, 0.8217, 0.8181, 0.8888, 0.8466}},
                                                         {0.5, {0.6879, 0.6830, 0.6983, 0.7453, 0.8601, 0.6999}},
                                                         {0.7, {0.5037, 0.5426, 0.5899, 0.6692, 0.8209, 0.5658}},
                                                         {1, {0.30685, 0.3789, 0.4507, 0.5601, 0.7602, 0.4085}}};
    for (const auto& [alpha, albedos] : known) {
        const std::vector<float> row = restRow(alpha, 1);
        for (std::size_t i = 0; i < 5; i++) EXPECT_NEAR(albedo(row, cosines[i]), albedos[i], 5e-4) << alpha << " " << i;
        EXPECT_NEAR(1 - row[REST_MEAN], albedos[5], 8e-4) << alpha;
    }
}

// The mean weight of samples is the albedo, and each weight is the value over the density, as both are for light
// samples.
TEST(Glossy, SamplesHaveTheWeightsOfTheirDensity) {
    for (const double alpha : {1e-3, 0.01, 0.1, 0.3, 0.7, 1.0})
        for (const double cosine : {1.0, 0.5, 0.1, 0.02})
            for (const auto& [material, row] :
                 {std::pair{metal(alpha), restRow(alpha, 1)}, std::pair{plastic(alpha), restRow(alpha, 0.04)}}) {
                std::vector<GlossyCase> xs;
                addGrid(xs, material, cosine, 128);
                const auto samples = map<GlossyValues>("glossy", xs);
                for (std::size_t i = 0; i < xs.size(); i++) xs[i].wi = samples[i].direction;
                const auto values = map<GlossyValues>("glossy", xs);
                Mean mean;
                for (std::size_t i = 0; i < xs.size(); i++) {
                    mean.add(samples[i].weight.x);
                    if (samples[i].direction.z < 1e-3f) continue;
                    ASSERT_NEAR(values[i].pdfAt / samples[i].pdf, 1, alpha < 0.01 ? 0.05 : 5e-3) << alpha << cosine;
                    ASSERT_NEAR(values[i].value.x / values[i].pdfAt, samples[i].weight.x, 1e-3) << alpha << cosine;
                }
                EXPECT_NEAR(mean.mean(), albedo(row, cosine), 2e-3) << alpha << " " << cosine;
            }
}

// The white furnace: what the glossy lobe reflects, by its samples, and the diffuse one by its albedo are all of the
// light, from wherever it comes; coloured, no channel has more.
TEST(Glossy, StandardMaterialsLoseAndGainNothing) {
    for (const double alpha : {1e-3, 0.1, 0.5, 1.0})
        for (const float metallic : {0.0f, 0.5f, 1.0f})
            for (const auto& [normalIncidence, grazing] : {std::pair{0.04f, 1.0f}, {0.5f, 1.0f}, {0.02f, 0.5f}}) {
                Scene scene = sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1);
                scene.rests = standardRows(alpha);
                const TestScene device(scene);
                for (const double cosine : {1.0, 0.5, 0.1}) {
                    const Material white = standard(alpha, metallic, vec3{1}, vec3{normalIncidence}, grazing),
                                   red = standard(alpha, metallic, {1, 0.5f, 0}, {0.5f, 0.04f, 0}, grazing);
                    std::vector<GlossyCase> xs;
                    const int side = 64;
                    for (const Material& material : {white, red}) addGrid(xs, material, cosine, side);
                    const auto samples = map<GlossyValues>("glossy", xs);
                    const std::vector<vec3> diffuse = map<vec3>(
                        "diffuse_albedo", std::vector<GlossyCase>{xs.front(), xs.back()}, {}, device.context());
                    glm::dvec3 sums[2]{};
                    for (std::size_t i = 0; i < xs.size(); i++)
                        sums[i / (side * side)] += glm::dvec3{samples[i].weight} / double(side * side);
                    for (int c = 0; c < 3; c++) {
                        EXPECT_NEAR(sums[0][c] + double{diffuse[0][c]}, 1, 3e-3) << alpha << metallic << cosine;
                        EXPECT_LT(sums[1][c] + double{diffuse[1][c]}, 1 + 3e-3) << alpha << metallic << cosine;
                    }
                }
            }
}

// Bins of cosine and angle; the expected counts are the density's, by a fine grid.
TEST(Glossy, SamplesFollowTheirDensity) {
    const int rows = 8, columns = 16, fine = 24;
    for (const double alpha : {0.1, 0.3, 1.0})
        for (const double cosine : {1.0, 0.6, 0.2}) {
            std::vector<GlossyCase> grid, xs;
            for (int i = 0; i < rows * fine; i++)
                for (int j = 0; j < columns * fine; j++)
                    grid.push_back({metal(alpha),
                                    direction(cosine, 0.1),
                                    direction((i + 0.5) / (rows * fine), (j + 0.5) / (columns * fine)),
                                    {}});
            std::vector<double> expected(rows * columns), counts(rows * columns);
            double whole = 0;
            for (std::size_t k = 0; const GlossyValues& y : map<GlossyValues>("glossy", grid)) {
                const std::size_t i = k / (columns * fine) / fine, j = k % (columns * fine) / fine;
                const double part = double{y.pdfAt} * 2 * pi / (rows * columns * fine * fine);
                expected[i * columns + j] += part;
                whole += part;
                k++;
            }
            const uint count = 1u << 18;
            for (const vec2 u : unitSquare(count, 3))
                xs.push_back({metal(alpha), direction(cosine, 0.1), {0, 0, 1}, u});
            for (const GlossyValues& y : map<GlossyValues>("glossy", xs)) {
                if (y.direction.z <= 0) continue;
                const int i = std::min(int(y.direction.z * rows), rows - 1),
                          j = std::min(int(turn(y.direction.x, y.direction.y) * columns), columns - 1);
                counts[std::size_t(i * columns + j)]++;
            }
            // Few samples go below the horizon, where nothing is evaluated.
            EXPECT_NEAR(whole, std::accumulate(counts.begin(), counts.end(), 0.0) / count, 0.01)
                << alpha << " " << cosine;
            double sum = 0, freedom = 0;
            for (std::size_t k = 0; k < counts.size(); k++) {
                const double e = expected[k] * count;
                if (e < 50) continue;
                sum += (counts[k] - e) * (counts[k] - e) / (e + std::pow(0.01 * e, 2)); // the grid is good to 1 %
                freedom++;
            }
            const double spread = 2 / (9 * freedom);
            EXPECT_LT((std::cbrt(sum / freedom) - 1 + spread) / std::sqrt(spread), 5) << alpha << " " << cosine;
        }
}

// Into glass of index 1.5 and out of it: reflected and refracted flux together, from an independent quadrature.
TEST(Glossy, RoughGlassLosesWhatFacetsScatterTwice) {
    const struct {
        double ior, alpha, cosine, whole;
    } known[]{{1.5, 0.1, 1, 0.9989},       {1.5, 0.5, 0.5, 0.8926},   {1.5, 1, 0.1, 0.7409},
              {1 / 1.5, 0.1, 0.5, 0.9634}, {1 / 1.5, 0.5, 1, 0.7539}, {1 / 1.5, 1, 0.5, 0.5128}};
    for (const auto& [ior, alpha, cosine, whole] : known) {
        const Material glass{MATERIAL_ROUGH_GLASS, vec3{1}, float(ior), 0, float(alpha), NONE};
        Random random(12);
        std::vector<GlossyCase> xs;
        for (int i = 0; i < 1 << 18; i++)
            xs.push_back({glass, direction(cosine, 0.2), {0, 0, 1}, random.unit2(), random.unit()});
        Mean mean;
        for (const GlossyValues& y : map<GlossyValues>("glossy", xs)) mean.add(y.weight.x);
        EXPECT_NEAR(mean.mean(), whole, 5 * mean.error() + 2e-4) << ior << " " << alpha << " " << cosine;
    }
}

TEST(Glossy, ValuesAreReciprocal) {
    Random random(9);
    std::vector<GlossyCase> forth, back;
    for (int i = 0; i < 100'000; i++) {
        const float alpha = random.between(0.01f, 1);
        const uint kind = random.bits() % 3;
        const Material material = kind == 0 ? metal(alpha, {0.9f, 0.5f, 0.2f})
                                  : kind == 1
                                      ? plastic(alpha)
                                      : standard(alpha, random.unit(), {0.9f, 0.5f, 0.2f}, {0.1f, 0, 0.3f}, 0.7f);
        const vec3 a = direction(random.between(0.01f, 1), random.unit()),
                   b = direction(random.between(0.01f, 1), random.unit());
        forth.push_back({material, a, b, {}});
        back.push_back({material, b, a, {}});
    }
    const auto there = map<GlossyValues>("glossy", forth), here = map<GlossyValues>("glossy", back);
    for (std::size_t i = 0; i < forth.size(); i++)
        for (int c = 0; c < 3; c++) {
            const double a = double{there[i].value[c]} / double{forth[i].wi.z},
                         b = double{here[i].value[c]} / double{back[i].wi.z};
            ASSERT_NEAR(a, b, 2e-5 * std::max(a, 1e-6)) << i;
        }
}

} // namespace
} // namespace vkpm
