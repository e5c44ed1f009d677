/// Fresnel reflectance, refraction and specular scattering against closed forms in double precision.
#include "judge.h"
#include "map.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;

double fresnel(double eta, double cosI) {
    const double sin2 = (1 - cosI * cosI) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double cosT = std::sqrt(1 - sin2);
    const double s = (cosI - eta * cosT) / (cosI + eta * cosT), p = (eta * cosI - cosT) / (eta * cosI + cosT);
    return (s * s + p * p) / 2;
}

double schlick(double eta, double cosI) {
    const double sin2 = (1 - cosI * cosI) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double r = std::pow((eta - 1) / (eta + 1), 2);
    return r + (1 - r) * std::pow(1 - (eta > 1 ? cosI : std::sqrt(1 - sin2)), 5);
}

Features fresnelFeatures(bool schlick) { return {.hasExactFresnel = !schlick, .hasSchlickFresnel = schlick}; }

float reflectance(double eta, double cosI, uint hasSchlick = 0) {
    return map<float>("fresnel_reflectance", std::vector{vec2{eta, cosI}}, fresnelFeatures(hasSchlick))[0];
}

double cosineOf(double degrees) { return std::cos(degrees * pi / 180); }

TEST(Fresnel, KnownValues) {
    EXPECT_NEAR(reflectance(1.5, 1), 0.04, 1e-7);
    EXPECT_NEAR(reflectance(1 / 1.5, 1), 0.04, 1e-7);
    EXPECT_NEAR(reflectance(1.5, cosineOf(60)), 0.0891867, 1e-6);
    EXPECT_EQ(reflectance(1.5, 0), 1);
    EXPECT_NEAR(reflectance(1, 0.3), 0, 1e-12);
    // Brewster's angle, where p vanishes: half of s is left, ((n^2 - 1) / (n^2 + 1))^2 / 2.
    EXPECT_NEAR(reflectance(1.5, cosineOf(56.3099)), 0.0739645, 1e-6);
    // The critical angle.
    EXPECT_LT(reflectance(1 / 1.5, cosineOf(41.8103 - 0.01)), 0.96);
    EXPECT_EQ(reflectance(1 / 1.5, cosineOf(41.8103 + 0.01)), 1);
    // A lossless plate, with all reflections between its faces.
    const double f = reflectance(1.5, 1);
    EXPECT_NEAR((1 - f) / (1 + f), 0.9230769, 1e-6);
}

std::vector<vec2> angles(double eta, int count) {
    std::vector<vec2> xs;
    for (int i = 0; i < count; i++) xs.push_back({eta, std::sqrt((i + 0.5) / count)});
    return xs;
}

TEST(Fresnel, CosineWeightedMeans) {
    for (const auto& [eta, expected] : {std::pair{1.5, 0.0917780}, {1 / 1.5, 0.5963458}}) {
        Mean mean;
        for (const float f : map<float>("fresnel_reflectance", angles(eta, 1 << 18))) mean.add(f);
        EXPECT_NEAR(mean.mean(), expected, 2e-6);
    }
}

TEST(Fresnel, AgreesWithDoublePrecision) {
    Random random(1);
    std::vector<vec2> xs;
    for (int i = 0; i < 100'000; i++) xs.push_back({std::exp2(random.between(-1.5f, 1.5f)), random.unit()});
    for (const uint hasSchlick : {0u, 1u}) {
        const auto ys = map<float>("fresnel_reflectance", xs, fresnelFeatures(hasSchlick));
        for (std::size_t i = 0; i < xs.size(); i++) {
            const double eta = xs[i].x, cosI = xs[i].y, cos2 = 1 - (1 - cosI * cosI) / (eta * eta);
            // The derivative is infinite at the critical angle: a rounding of 1e-7 there becomes its square root.
            const double slack = 1e-6 + 2e-6 / std::sqrt(std::abs(cos2) + 1e-7);
            ASSERT_NEAR(ys[i], hasSchlick ? schlick(eta, cosI) : fresnel(eta, cosI), slack) << eta << " " << cosI;
        }
    }
}

TEST(Fresnel, SchlickDeviatesAsMuchAsItShould) {
    const auto xs = angles(1.5, 1 << 16);
    const auto exact = map<float>("fresnel_reflectance", xs),
               approximate = map<float>("fresnel_reflectance", xs, fresnelFeatures(1));
    double absolute = 0, relative = 0;
    for (std::size_t i = 0; i < xs.size(); i++) {
        absolute = std::max(absolute, std::abs(double{approximate[i]} - exact[i]));
        relative = std::max(relative, std::abs(double{approximate[i]} / exact[i] - 1));
    }
    EXPECT_NEAR(absolute, 0.036, 0.001);
    EXPECT_NEAR(relative, 0.23, 0.01);
}

TEST(Fresnel, IsTheSameFromBothSides) {
    std::vector<vec2> in, out;
    for (const vec2 x : angles(1.5, 1'000)) {
        in.push_back(x);
        out.push_back({1 / x.x, std::sqrt(1 - (1 - x.y * x.y) / (x.x * x.x))});
    }
    for (const uint hasSchlick : {0u, 1u}) {
        const auto one = map<float>("fresnel_reflectance", in, fresnelFeatures(hasSchlick));
        const auto other = map<float>("fresnel_reflectance", out, fresnelFeatures(hasSchlick));
        for (std::size_t i = 0; i < in.size(); i++) ASSERT_NEAR(one[i], other[i], 1e-5);
    }
}

const vec3 tint{0.9f, 0.8f, 0.7f};
const Features smooth{}, flat{.hasSmoothNormals = 0};

ScatterCase glass(float ior, vec3 n, vec3 d, float u) { return {{MATERIAL_GLASS, tint, ior}, n, n, d, u}; }

std::vector<ScatterValues> scatter(const std::vector<ScatterCase>& xs, const Features& features = flat) {
    return map<ScatterValues>("scatter_specular", xs, features);
}

const float justBelowOne = 1 - 0x1p-24f;

TEST(Scatter, RefractsBySnellsLaw) {
    Random random(2);
    std::vector<ScatterCase> xs;
    for (int i = 0; i < 50'000; i++)
        xs.push_back(glass(random.between(1.01f, 2.5f), random.direction(), random.direction(), justBelowOne));
    const auto ys = scatter(xs);
    for (std::size_t i = 0; i < xs.size(); i++) {
        const dvec3 d = xs[i].direction, out = dvec3(xs[i].normal);
        const bool leaving = glm::dot(d, out) > 0;
        const dvec3 n = leaving ? -out : out;
        const double eta = leaving ? 1 / double{xs[i].material.ior} : double{xs[i].material.ior},
                     cosI = -glm::dot(d, n);
        const double cos2 = 1 - (1 - cosI * cosI) / (eta * eta);
        if (std::abs(cos2) < 1e-3 || cosI < 1e-3) continue;
        const dvec3 expected = cos2 < 0 ? d + 2 * cosI * n : (d + cosI * n) / eta - std::sqrt(cos2) * n;
        ASSERT_LT(glm::length(dvec3(ys[i].direction) - expected), 1e-5) << eta << " " << cosI;
        ASSERT_NEAR(ys[i].radianceScale * (cos2 < 0 ? 1 : eta * eta), 1, 1e-6);
        ASSERT_EQ(ys[i].weight, cos2 < 0 ? vec3(1) : tint);
        ASSERT_EQ(ys[i].normal, vec3(n));
    }
}

TEST(Scatter, RefractionIsReversible) {
    Random random(3);
    std::vector<ScatterCase> xs, back;
    for (int i = 0; i < 20'000; i++) {
        const vec3 n = random.direction();
        vec3 d = random.direction();
        if (glm::dot(d, n) > 0) d = -d;
        if (glm::dot(d, n) < -0.02f) xs.push_back(glass(1.5f, n, d, justBelowOne));
    }
    for (std::size_t i = 0; const ScatterValues& y : scatter(xs))
        back.push_back(glass(1.5f, xs[i++].normal, -y.direction, justBelowOne));
    const auto again = scatter(back);
    for (std::size_t i = 0; i < xs.size(); i++) ASSERT_LT(glm::length(again[i].direction + xs[i].direction), 2e-5);
}

// The fraction reflected is the Fresnel reflectance, within 5 standard deviations.
TEST(Scatter, ReflectsTheFractionOfFresnel) {
    Random random(4);
    const int count = 100'000;
    for (const float ior : {1.5f, 1 / 1.5f})
        for (const float cosine : {1.0f, 0.5f, 0.2f, 0.05f}) {
            const vec3 d{std::sqrt(1 - cosine * cosine), 0, -cosine};
            std::vector<ScatterCase> xs;
            for (int i = 0; i < count; i++) xs.push_back(glass(ior, {0, 0, 1}, d, random.unit()));
            double reflected = 0;
            for (const ScatterValues& y : scatter(xs)) {
                if (y.direction.z < 0) continue;
                reflected++;
                ASSERT_LT(glm::length(y.direction - vec3{d.x, 0, -d.z}), 1e-6);
                ASSERT_EQ(y.weight, vec3(1));
            }
            const double f = fresnel(ior, cosine);
            EXPECT_NEAR(reflected / count, f, 5 * std::sqrt(f * (1 - f) / count) + 1e-6) << ior << " " << cosine;
        }
}

TEST(Scatter, MirrorsReflectFromBothSides) {
    const Material mirror{MATERIAL_MIRROR, tint, 0};
    const vec3 n = glm::normalize(vec3{1, 2, 3});
    for (const vec3 d : {glm::normalize(vec3{1, -3, -2}), glm::normalize(vec3{1, 3, 2})})
        for (const Features& features : {flat, smooth, Features{.materialKinds = 1u << MATERIAL_MIRROR}}) {
            const ScatterValues y = scatter({{mirror, n, n, d, 0.999f}}, features)[0];
            EXPECT_LT(glm::length(y.direction - (d - 2 * glm::dot(d, n) * n)), 1e-6);
            EXPECT_EQ(y.weight, tint);
            EXPECT_EQ(y.radianceScale, 1);
        }
}

// Whatever the shading normal, reflection stays on the side of incidence and refraction on the other; where the event
// about the shading normal does so, it is the one taken.
TEST(Scatter, ShadingNormalsNeverPutLightOnTheWrongSide) {
    Random random(5);
    std::vector<ScatterCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 n = random.direction();
        vec3 shading = glm::normalize(n + random.cube(0.7f));
        if (glm::dot(shading, n) < 0) shading = -shading;
        xs.push_back({{random.bits() % 2 ? MATERIAL_GLASS : MATERIAL_MIRROR, tint, 1.5f},
                      n,
                      shading,
                      random.direction(),
                      random.unit()});
    }
    const auto ys = scatter(xs, smooth);
    int aboutShading = 0;
    for (std::size_t i = 0; i < xs.size(); i++) {
        const float in = glm::dot(xs[i].direction, xs[i].normal), out = glm::dot(ys[i].direction, xs[i].normal);
        const bool reflected = ys[i].radianceScale == 1;
        if (std::abs(out) > 1e-5f) {
            ASSERT_EQ(reflected, in * out < 0) << i;
        }
        ASSERT_NEAR(glm::length(ys[i].direction), 1, 1e-5);
        aboutShading += std::abs(glm::dot(ys[i].normal, xs[i].shading)) > 0.999999f;
    }
    EXPECT_GT(aboutShading, 60'000);
}

// What shading normals do to a path they do not do to it backwards; about the geometric normal, on either side, they do
// nothing.
TEST(Scatter, SpecularCorrectionOfAPathAndItsReverseCancel) {
    Random random(6);
    std::vector<CorrectionCase> forth, back, flatOnes;
    for (int i = 0; i < 1'000; i++) {
        const CorrectionCase x{random.direction(), random.direction(), random.direction(), random.direction()};
        const auto& [wi, wo, n, g] = x;
        if (std::min({std::abs(glm::dot(wi, n)), std::abs(glm::dot(wi, g)), std::abs(glm::dot(wo, n)),
                      std::abs(glm::dot(wo, g))}) > 0.03f) {
            forth.push_back(x);
            back.push_back({wo, wi, n, g});
        }
        flatOnes.push_back({wi, wo, g, g});
        flatOnes.push_back({wi, wo, -g, g});
    }
    ASSERT_GT(forth.size(), 700u);
    const auto a = map<float>("specular_correction", forth), b = map<float>("specular_correction", back),
               ones = map<float>("specular_correction", forth, flat);
    std::size_t far = 0;
    for (std::size_t i = 0; i < forth.size(); i++) {
        ASSERT_NEAR(double{a[i]} * double{b[i]}, 1, 1e-4);
        far += std::abs(a[i] - 1) > 0.1f;
        ASSERT_EQ(ones[i], 1);
    }
    EXPECT_GT(far, forth.size() / 2);
    for (const float one : map<float>("specular_correction", flatOnes)) ASSERT_EQ(one, 1);
    EXPECT_TRUE(std::isfinite(map<float>(
        "specular_correction", std::vector<CorrectionCase>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}}})[0]));
}

TEST(Scatter, SpecularSurvival) {
    const auto ys = map<vec2>(
        "specular_survival",
        std::vector<vec4>{
            {1, 1, 1, 0}, {1, 1, 1, 31}, {1, 1, 1, 32}, {0.5f, 0.2f, 0.1f, 3}, {0.1f, 0.2f, 0.5f, 99}, {0, 0, 0, 0}});
    EXPECT_EQ(ys, (std::vector<vec2>{{1, 1}, {1, 1}, {0.95f, 0.9f}, {0.5f, 0.5f}, {0.5f, 0.5f}, {0, 0}}));
}

TEST(Material, IsDiffuse) {
    const std::vector<Material> all{
        {MATERIAL_DIFFUSE, tint, 0}, {MATERIAL_MIRROR, tint, 0}, {MATERIAL_GLASS, tint, 1.5f}};
    EXPECT_EQ(map<uint>("is_diffuse", all), (std::vector<uint>{1, 0, 0}));
    EXPECT_EQ(map<uint>("is_diffuse", std::vector{all[0]}, {.materialKinds = 1u << MATERIAL_DIFFUSE}),
              std::vector<uint>{1});
}

// As many channels as there are indices, each by Snell's law; their weights are those of Fresnel's equations.
TEST(Scatter, PrismBendsColoursApart) {
    const double ior = 1.5, spread = 0.5 / (2 * 55);
    Material glass{MATERIAL_GLASS, vec3{1}, float(ior)};
    glass.spread = {-spread, spread};
    const Features features{.hasSmoothNormals = 0};
    std::vector<ScatterCase> into, out;
    const vec3 d = glm::normalize(vec3{0.6f, -0.8f, 0});
    const int count = 999;
    for (int i = 0; i < count; i++) into.push_back({glass, {0, 1, 0}, {0, 1, 0}, d, (i + 0.5f) / count});
    const double apex = pi / 6;
    const dvec3 face{std::sin(apex), -std::cos(apex), 0};
    for (const ScatterValues& y : map<ScatterValues>("scatter_specular", into, features))
        out.push_back({glass, vec3{face}, vec3{face}, y.direction, 1 - 0x1p-20f});
    const auto entered = map<ScatterValues>("scatter_specular", into, features);
    dvec3 transmitted{0}, reflected{0};
    for (const ScatterValues& y : entered)
        (y.direction.y < 0 ? transmitted : reflected) += dvec3{y.weight} / double(count);
    for (int channel = 0; channel < 3; channel++) {
        const double n = ior + (channel - 1) * spread, cosT = std::sqrt(1 - 0.36 / (n * n));
        const double s = (0.8 - n * cosT) / (0.8 + n * cosT), p = (n * 0.8 - cosT) / (n * 0.8 + cosT);
        EXPECT_NEAR(reflected[channel], (s * s + p * p) / 2, 2e-3);
        EXPECT_NEAR(transmitted[channel] + reflected[channel], 1, 4e-3);
        int found = 0;
        for (int i = 0; i < count; i++) {
            const ScatterValues& y = entered[std::size_t(i)];
            if (y.direction.y > 0 || y.weight[channel] == 0) continue;
            found++;
            ASSERT_NEAR(y.weight.x + y.weight.y + y.weight.z, 3, 0.02) << "one channel alone";
            ASSERT_NEAR(y.direction.x, 0.6 / n, 1e-6);
        }
        EXPECT_NEAR(found, count / 3.0, 20);
    }
    // Through both faces of the prism.
    const auto left = map<ScatterValues>("scatter_specular", out, features);
    for (std::size_t i = 0; i < left.size(); i++) {
        if (entered[i].direction.y > 0 || dot(left[i].direction, vec3{face}) < 0) continue;
        for (int first = 0; first < 3; first++)
            for (int second = 0; second < 3; second++) {
                if (entered[i].weight[first] == 0 || left[i].weight[second] == 0) continue;
                const double n = ior + (first - 1) * spread, m = ior + (second - 1) * spread;
                const dvec3 within{0.6 / n, -std::sqrt(1 - 0.36 / (n * n)), 0};
                const double sine = glm::length(glm::cross(within, face)) * m;
                ASSERT_NEAR(glm::length(glm::cross(dvec3{left[i].direction}, face)), sine, 1e-5);
            }
    }
}

// As much of the light along one way is kept as along the way back: solid angles about the surface times what is kept.
TEST(Material, MappedNormalsKeepAsMuchBothWays) {
    Random random(4);
    std::vector<CorrectionCase> forth, back;
    for (int i = 0; i < 10'000; i++) {
        const vec3 normal = random.direction(), mapped = glm::normalize(normal + 0.9f * random.direction());
        const vec3 d = random.direction(), w = random.direction();
        forth.push_back({d, w, mapped, normal});
        back.push_back({-w, -d, mapped, normal});
    }
    const auto there = map<float>("mapped_acceptance", forth), here = map<float>("mapped_acceptance", back);
    double least = 1;
    for (std::size_t i = 0; i < forth.size(); i++) {
        const auto& [d, w, mapped, normal] = forth[i];
        const auto cosine = [](vec3 a, vec3 b) { return std::abs(glm::dot(glm::dvec3{a}, glm::dvec3{b})); };
        const double a = double{there[i]} * cosine(d, normal) * cosine(w, mapped),
                     b = double{here[i]} * cosine(w, normal) * cosine(d, mapped);
        ASSERT_NEAR(a, b, 1e-5 * a + 1e-7) << i;
        ASSERT_LE(there[i], 1) << i;
        least = std::min(least, double{there[i]});
    }
    EXPECT_LT(least, 0.01);
}

} // namespace
} // namespace vkpm
