/// The functions in which single precision could hurt, over inputs that are hard for it, against double precision.
#include "judge.h"
#include "map.h"
#include "precision.h"
#include "render/radius.h"
#include "scene/box.h"
#include "scene_on_device.h"
#include <gtest/gtest.h>

namespace vkpm {
namespace {

using glm::dvec3;
template <std::size_t N> using Inputs = std::array<double, N>;

/// Prints a row of the table and holds it against bounds: of the worst error in roundings, and of the mean in ulps.
void judge(const Precision& precision, double maxRoundings, double meanUlps) {
    fmt::print("{}\n", precision.row());
    EXPECT_GE(precision.count, 10'000) << precision.name << ", " << precision.where;
    EXPECT_LE(precision.maxRoundings, maxRoundings) << precision.name << ", " << precision.where;
    EXPECT_LE(precision.sumUlps / precision.count, meanUlps) << precision.name << ", " << precision.where;
}

dvec3 vectorAt(const auto& inputs, std::size_t first) { return {inputs[first], inputs[first + 1], inputs[first + 2]}; }

// ---- Rays ----

/// t and the weights of b and c (Moeller & Trumbore 1997).
dvec3 exactTriangle(const Inputs<15>& x) {
    const dvec3 o = vectorAt(x, 0), d = vectorAt(x, 3), a = vectorAt(x, 6), u = vectorAt(x, 9) - a,
                v = vectorAt(x, 12) - a;
    const dvec3 p = glm::cross(d, v), s = o - a, q = glm::cross(s, u);
    return dvec3{glm::dot(v, q), glm::dot(s, p), glm::dot(d, q)} / glm::dot(u, p);
}

/// A ray from `distance` away to a point of a triangle of which one side is `thin` times as long as the others.
TriangleCase aimedAt(Random& random, float distance, float thin) {
    TriangleCase x;
    const vec3 center = random.cube(1);
    x.a = center;
    x.b = center + random.cube(0.5f);
    x.c = x.b + random.cube(0.5f) * thin;
    vec2 w = random.unit2();
    if (w.x + w.y > 1) w = vec2(1) - w;
    const vec3 target = x.a * (1 - w.x - w.y) + x.b * w.x + x.c * w.y;
    x.direction = random.direction();
    x.origin = target - x.direction * distance;
    x.direction *= std::exp2(random.between(-4, 4));
    return x;
}

void judgeTriangles(const char* where, float distance, float thin, double maxRoundings, double meanUlps) {
    Random random(1);
    std::vector<TriangleCase> xs;
    for (int i = 0; i < 100'000; i++) xs.push_back(aimedAt(random, distance, thin));
    const auto ys = map<vec3>("intersect_triangle", xs);
    Precision t("triangle: distance", where), weight("triangle: weight", where);
    for (std::size_t i = 0; i < xs.size(); i++) {
        if (ys[i].x <= 0) continue;
        t.add(double{ys[i].x}, doublesOf(xs[i]), [](const Inputs<15>& x) { return exactTriangle(x).x; });
        weight.add(double{ys[i].y}, doublesOf(xs[i]), [](const Inputs<15>& x) { return exactTriangle(x).y; });
    }
    judge(t, maxRoundings, meanUlps);
    judge(weight, 6, INFINITY);
}

TEST(Precision, Triangles) {
    judgeTriangles("from about its size away", 1, 1, 4, 4);
    judgeTriangles("from 1000 times its size away", 1000, 1, 5, 4);
    // The weights of a sliver are rounded each on its own, and t is made of them; the place of a hit, too, which so
    // stays on it.
    judgeTriangles("slivers 1:1000", 1, 1e-3f, 5000, 70);
}

double exactSphere(const Inputs<13>& x) {
    const dvec3 f = vectorAt(x, 0) - vectorAt(x, 6), d = vectorAt(x, 3);
    const double a = glm::dot(d, d), b = -glm::dot(f, d);
    const dvec3 across = f + b / a * d;
    const double half = std::sqrt(a * (x[9] * x[9] - glm::dot(across, across)));
    return (b - half > 0 ? b - half : b + half) / a;
}

void judgeSpheres(const char* where, float distance, float pass, double maxRoundings, double meanUlps) {
    Random random(2);
    std::vector<SphereCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 d = random.direction(), across = glm::normalize(glm::cross(d, random.direction()));
        SphereCase x{{}, d, random.cube(1), std::exp2(random.between(-3, 3))};
        x.origin = x.center + x.radius * (across * (pass < 1 ? random.between(0, pass) : 1 - random.between(0, 1e-3f)) -
                                          distance * d);
        x.pole = poleOf(x.center, double{x.radius});
        xs.push_back(x);
    }
    const auto ys = map<float>("intersect_sphere", xs);
    Precision t("sphere: distance", where);
    for (std::size_t i = 0; i < xs.size(); i++)
        if (ys[i] > 0) t.add(double{ys[i]}, doublesOf(xs[i]), exactSphere);
    judge(t, maxRoundings, meanUlps);
}

TEST(Precision, Spheres) {
    judgeSpheres("from 1.5 radii away", 1.5f, 0.99f, 8, 3);
    judgeSpheres("from 3 radii away", 3, 0.99f, 5, 2);
    judgeSpheres("from 1000 radii away", 1000, 0.99f, 6, 2);
    judgeSpheres("near the tangent", 3, 1, 3, 15);
    judgeSpheres("from inside", 0.1f, 0.9f, 3, 1);
}

TEST(Precision, Offsets) {
    Random random(3);
    std::vector<OffsetCase> xs;
    for (int i = 0; i < 100'000; i++) {
        const vec3 p = random.cube(1) * std::exp2(random.between(-20, 20));
        xs.push_back({p, glm::abs(p) + glm::abs(random.cube(1)), random.direction()});
    }
    const auto ys = map<vec3>("offset_point", xs);
    Precision x("ray offset", "from 1e-6 to 1e6");
    for (std::size_t i = 0; i < xs.size(); i++)
        x.add(double{ys[i].x}, doublesOf(xs[i]), [](const Inputs<9>& c) {
            return c[0] + c[6] * 0x1p-18 * (std::abs(c[6]) * c[3] + std::abs(c[7]) * c[4] + std::abs(c[8]) * c[5]);
        });
    judge(x, 3, 1);
}

// ---- Glass ----

double exactFresnel(const Inputs<2>& x) {
    const double eta = x[0], cosI = x[1], cos2 = 1 - (1 - cosI * cosI) / (eta * eta);
    if (cos2 <= 0) return 1;
    const double cosT = std::sqrt(cos2);
    const double s = (cosI - eta * cosT) / (cosI + eta * cosT), p = (eta * cosI - cosT) / (eta * cosI + cosT);
    return (s * s + p * p) / 2;
}

double exactSchlick(const Inputs<2>& x) {
    const double eta = x[0], cosI = x[1], cos2 = 1 - (1 - cosI * cosI) / (eta * eta);
    if (cos2 <= 0) return 1;
    const double r = (eta - 1) / (eta + 1);
    return r * r + (1 - r * r) * std::pow(1 - (eta > 1 ? cosI : std::sqrt(cos2)), 5);
}

struct GlassRange {
    const char* where;
    std::vector<vec2> inputs; // eta, cosine
};

/// What is allowed in each range: roundings at most, ulps in the mean. Near the critical angle ulps without number are
/// but few roundings: there the result hangs on the last bits of what goes in.
using GlassBounds = std::array<vec2, 3>;

/// Ordinary glass from both sides, glass that hardly refracts, glass near the critical angle.
std::vector<GlassRange> glassRanges() {
    Random random(4);
    std::vector<GlassRange> ranges{{"ratio of indices 0.4 to 2.5", {}},
                                   {"ratio off 1 by 1e-6 to 1e-2", {}},
                                   {"just within the critical angle", {}}};
    for (int i = 0; i < 100'000; i++) {
        ranges[0].inputs.push_back({std::exp2(random.between(-1.32f, 1.32f)), random.unit()});
        const float off = std::exp2(random.between(-20, -6.6f));
        ranges[1].inputs.push_back({random.unit() < 0.5f ? 1 + off : 1 / (1 + off), random.between(0.2f, 1)});
        const double eta = double{random.between(0.4f, 0.95f)}, critical = std::sqrt((1 - eta) * (1 + eta));
        const vec2 x{float(eta), float(critical * (1 + std::exp2(double{random.between(-20, -4)})))};
        if (x.y < 1) ranges[2].inputs.push_back(x);
    }
    return ranges;
}

void judgeFresnel(const char* name, bool schlick, double (*exact)(const Inputs<2>&), const GlassBounds& bounds) {
    const vec2* bound = bounds.data();
    for (const GlassRange& range : glassRanges()) {
        const auto ys = map<float>("fresnel_reflectance", range.inputs,
                                   {.hasExactFresnel = !schlick, .hasSchlickFresnel = schlick});
        Precision precision(name, range.where);
        for (std::size_t i = 0; i < ys.size(); i++) precision.add(double{ys[i]}, doublesOf(range.inputs[i]), exact);
        judge(precision, double{bound->x}, double{bound->y});
        bound++;
    }
}

TEST(Precision, Fresnel) { judgeFresnel("Fresnel, exact", 0, exactFresnel, {vec2{12, 2}, {0.2f, 3}, {3, INFINITY}}); }
TEST(Precision, Schlick) { judgeFresnel("Fresnel, Schlick", 1, exactSchlick, {vec2{6, 1.5f}, {8, 6}, {4, INFINITY}}); }

/// Directions in the plane of x and z, from above a surface whose normal is z: the refracted one, by Snell's law.
TEST(Precision, Refraction) {
    const GlassBounds bounds{vec2{4, 2}, {3, 1}, {3, INFINITY}};
    const vec2* bound = bounds.data();
    for (const GlassRange& range : glassRanges()) {
        std::vector<ScatterCase> xs;
        for (const vec2 x : range.inputs) {
            const vec3 d{std::sqrt(1 - double{x.y} * x.y), 0, -x.y}, n{0, 0, 1};
            xs.push_back({{MATERIAL_GLASS, vec3(1), x.x}, n, n, d, 1 - 0x1p-24f});
        }
        const auto ys = map<ScatterValues>("scatter_specular", xs, {.hasSmoothNormals = 0});
        Precision precision("refraction: cosine", range.where);
        for (std::size_t i = 0; i < ys.size(); i++)
            if (ys[i].direction.z < 0) // refracted
                precision.add(-double{ys[i].direction.z}, doublesOf(range.inputs[i]),
                              [](const Inputs<2>& x) { return std::sqrt(1 - (1 - x[1] * x[1]) / (x[0] * x[0])); });
        judge(precision, double{bound->x}, double{bound->y});
        bound++;
    }
}

// ---- Photons ----

double exactWeight(uint kernel, double x2) {
    const double k = 1.1, beta = 1.953, end = 1 - std::exp(-beta);
    switch (kernel) {
    case DENSITY_KERNEL_CONE:
        return (1 - std::sqrt(x2) / k) / (1 - 2 / (3 * k));
    // Pavicic's alpha = 0.918 cancels. The mean of 1 - (1 - exp(-beta x2 / 2)) / end over x2 in [0, 1].
    case DENSITY_KERNEL_GAUSS:
        return (1 - (1 - std::exp(-beta * x2 / 2)) / end) / (1 - (1 - (1 - std::exp(-beta / 2)) / (beta / 2)) / end);
    case DENSITY_KERNEL_EPANECHNIKOV:
        return 2 * (1 - x2);
    default:
        return 1;
    }
}

TEST(Precision, DensityKernels) {
    const int count = 1 << 17;
    for (const auto& [name, kernel] : {std::pair("constant", DENSITY_KERNEL_CONSTANT),
                                       {"cone", DENSITY_KERNEL_CONE},
                                       {"Gauss", DENSITY_KERNEL_GAUSS},
                                       {"Epanechnikov", DENSITY_KERNEL_EPANECHNIKOV}}) {
        std::vector<vec2> xs;
        for (int i = 0; i < count; i++) xs.push_back({kernel, (float(i) + 0.5f) / float(count)});
        const auto ys = map<float>("density_weight", xs);
        Precision precision(std::string("kernel: ") + name, "the disc");
        double mean = 0;
        for (int i = 0; i < count; i++) {
            precision.add(double{ys[i]}, std::array{double{xs[i].y}},
                          [&](const Inputs<1>& x) { return exactWeight(kernel, x[0]); });
            mean += double{ys[i]} / count;
        }
        judge(precision, kernel == DENSITY_KERNEL_GAUSS ? 15 : 8, 3.5);
        fmt::print("| kernel: {}, mean weight less one | the disc | {:.1e} | | | |\n", name, mean - 1);
        EXPECT_NEAR(mean, 1, 2e-7) << name;
    }
}

/// The schedule as it is defined, pass by pass.
TEST(Precision, RadiusSchedule) {
    Precision precision("radius schedule", "passes 1 to 1,000,000");
    double drift = 0;
    for (const float alpha : {0.05f, 1 / 3.0f, 0.5f, 2 / 3.0f, 0.9f, 1.0f}) {
        long double logarithm = 0, exact = 1; // of r^2
        float singly = 1;
        for (uint pass = 0; pass < 1'000'000; pass++) {
            if (pass % 97 == 0) {
                exact = std::exp(logarithm / 2);
                precision.addError(double(std::abs(radiusFactor(pass, alpha) - exact)), ulpOf(double(exact)),
                                   ulpOf(double(exact)) / 2);
            }
            const long double i = pass + 1;
            logarithm += std::log1p((static_cast<long double>(alpha) - 1) / (i + 1));
            singly *= (float(i) + alpha) / (float(i) + 1);
        }
        drift = std::max(drift, std::abs(std::sqrt(double{singly}) / double(std::exp(logarithm / 2)) - 1));
    }
    judge(precision, 1.01, 0.5);
    fmt::print("| (pass by pass in floats) | after 1,000,000 passes | {:.3g} | | | |\n", drift * 0x1p23);
}

/// The solid angle of the square [-0.5, 0.5]^2 of the plane z = 0.
double exactSolidAngle(const Inputs<3>& x) {
    double sum = 0;
    for (const double s : {-0.5, 0.5})
        for (const double t : {-0.5, 0.5}) {
            const double w = s - x[0], h = t - x[1];
            sum += (s * t > 0 ? 1 : -1) * std::atan2(w * h, std::abs(x[2]) * std::sqrt(w * w + h * h + x[2] * x[2]));
        }
    return sum;
}

TEST(Precision, SolidAngle) {
    Random random(6);
    std::vector<VectorPair> xs;
    for (int i = 0; i < 100'000; i++)
        xs.push_back({{random.between(-1.5f, 1.5f), random.between(-1.5f, 1.5f), std::exp2(random.between(-12, 0.5f))},
                      {0.5f, 0.5f, 0}});
    Scene scene = sceneOf({triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1);
    scene.lights = {{.a = {-0.5f, -0.5f, 0},
                     .u = {1, 0, 0},
                     .v = {0, 1, 0},
                     .radiance = vec3(1),
                     .kind = LIGHT_RECTANGLE,
                     .area = 1}};
    scene.lightCdf = {1};
    const TestScene onDevice(scene);
    const auto ys = map<LightSampleValues>("light_sample", xs, {}, onDevice.context());
    Precision precision("solid angle of a square", "2^-12 to 2 of its side away");
    for (std::size_t i = 0; i < xs.size(); i++)
        precision.add(double{ys[i].inversePdf}, std::array{double{xs[i].a.x}, double{xs[i].a.y}, double{xs[i].a.z}},
                      exactSolidAngle);
    judge(precision, 2000, 1); // 841 on lavapipe, 1672 on an NVIDIA H100
}

TEST(Precision, Sampling) {
    Random random(5);
    std::vector<float> turns;
    std::vector<vec2> cones;
    std::vector<vec2> square = unitSquare(100'000, 6);
    for (int i = 0; i < 100'000; i++) {
        turns.push_back(random.unit());
        cones.push_back({std::exp2(random.between(-30, 0)), 1}); // radius, squared distance
    }
    const auto points = map<vec2>("unit_circle", turns);
    Precision circle("unit circle", "all turns, in ulps of 1");
    for (std::size_t i = 0; i < turns.size(); i++) {
        const double angle = 2 * pi * double{turns[i]};
        for (const double error : {points[i].x - std::cos(angle), points[i].y - std::sin(angle)})
            circle.addError(std::abs(error), 0x1p-23, 0x1p-24);
    }
    judge(circle, 3, 0.3);

    const auto heights = map<float>("cone_height", cones);
    Precision cone("cone of a sphere", "radius 1e-9 to 1 of the distance");
    for (std::size_t i = 0; i < cones.size(); i++)
        cone.add(double{heights[i]}, doublesOf(cones[i]), [](const Inputs<2>& x) {
            const double sin2 = x[0] * x[0] / x[1];
            return sin2 / (1 + std::sqrt(1 - sin2));
        });
    judge(cone, 2, 0.6);

    const auto directions = map<vec3>("cosine_hemisphere", square);
    Precision length("cosine hemisphere: length", "in ulps of 1");
    for (const vec3 d : directions) length.addError(std::abs(glm::length(dvec3{d}) - 1), 0x1p-23, 0x1p-24);
    judge(length, 2, 0.3);
}

} // namespace
} // namespace vkpm
