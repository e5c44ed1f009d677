/// Reading of suns, points and spots.
#include "scene/lamps.h"
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace vkpm {
using glm::dvec3;

namespace {

constexpr std::size_t manyLamps = 10'000'000;
constexpr Range acrossSun{0.001f, 180};

std::size_t countLamps(const Reader& lights) { return lights.count(0, manyLamps, "an array of lights"); }

std::size_t kindOf(Reader& lamp) {
    (void)lamp.find("name");
    return lamp.at("type").choice({"sun", "point", "spot"});
}

dvec3 readDirection(const Reader& reader) {
    const dvec3 direction = reader.place();
    if (!(glm::length(direction) > 0))
        reader.fail("the direction has length 0", "give a direction of any other length");
    return glm::normalize(direction);
}

/// One minus the cosine of an angle in degrees.
double heightOf(double degrees) {
    const double sine = std::sin(glm::radians(degrees) / 2);
    return 2 * sine * sine;
}

/// A radiance or an intensity that floats can hold.
vec3 requireFloat(const Reader& reader, dvec3 value) {
    const vec3 rounded{value};
    if (!std::isfinite(rounded.x + rounded.y + rounded.z))
        reader.fail("what it sends overflows", "give less, or a larger angle or radius");
    return rounded;
}

/// L = E / (pi sin^2 a), which a surface that faces it receives as E.
void addSun(Reader sun, Scene& scene) {
    const dvec3 direction = readDirection(sun.at("direction"));
    const Reader strength = sun.at("irradiance");
    double degrees = 0.53;
    if (const auto angle = sun.find("angle")) degrees = double{angle->number(acrossSun)};
    sun.finish();
    const double sine = std::sin(glm::radians(degrees / 2));
    const vec3 radiance =
        requireFloat(strength, dvec3{strength.color(notNegative)} / (glm::pi<double>() * sine * sine));
    if (radiance == vec3{0}) return;
    scene.lights.push_back({.a = vec3{direction},
                            .u = vec3{dvec3{sine, heightOf(degrees / 2), 0}},
                            .radiance = radiance,
                            .kind = LIGHT_SUN,
                            .share = 1});
}

/// Where the lamp is, on the device.
vec3 readPosition(const Reader& reader, const Scene& scene) {
    const vec3 position{scene.coordinates.inside(reader.place())};
    const double reach = scene.coordinates.unit * glm::length(dvec3{position});
    if (!(reach <= 1e12)) reader.fail(fmt::format("the light is {:.3g} away", reach), "allowed are 1e12");
    return position;
}

/// The area is the solid angle that the full intensity would fill with the flux of the spot, over pi.
void readCones(Reader& spot, Light& light) {
    const auto inner = spot.find("inner");
    const Reader outer = spot.at("outer");
    const double wide = double{outer.number({0, 90, true})}, narrow = inner ? double{inner->number({0, 90})} : 0;
    if (narrow > wide) inner->fail("the inner angle is wider than the outer one", "let it be as wide at most");
    const double height = heightOf(wide), between = height - heightOf(narrow);
    light.u = vec3{readDirection(spot.at("direction"))};
    light.v = vec3{dvec3{height, between > 1e-30 ? 1 / between : 1e30, 0}};
    light.area = static_cast<float>(2 * (height - between + between / 3));
}

/// A ball of radiance I / (pi r^2), with the beam of a spot if `like` is one.
void addBall(const Reader& lamp, const Reader& position, double radius, dvec3 intensity, const Light& like,
             Scene& scene, ShapeLoader& loader) {
    const dvec3 center = position.place(), radiance = intensity / (glm::pi<double>() * radius * radius);
    (void)requireFloat(lamp, radiance);
    const nlohmann::json sphere{{"type", "sphere"},
                                {"center", {center.x, center.y, center.z}},
                                {"radius", radius},
                                {"emission", {radiance.x, radiance.y, radiance.z}}};
    loader.add(Reader{lamp.path(), sphere});
    if (like.kind != LIGHT_SPOT) return;
    Light& ball = scene.lights.back();
    ball.u.y = like.v.x;
    ball.u.z = like.v.y;
    ball.v = like.u;
    ball.area = static_cast<float>(glm::pi<double>() * double{ball.u.x} * double{ball.u.x} * double{like.area});
}

void addLamp(Reader lamp, Scene& scene, ShapeLoader& loader) {
    const std::size_t kind = kindOf(lamp);
    if (kind == 0) return;
    const Reader position = lamp.at("position"), strength = lamp.at("intensity");
    const dvec3 intensity{strength.color(notNegative)};
    const auto size = lamp.find("radius");
    const double radius = size ? double{size->number(notNegative)} : 0;
    const double unit = scene.coordinates.unit;
    Light light{.a = readPosition(position, scene),
                .radiance = requireFloat(strength, intensity / (unit * unit)),
                .kind = kind == 1 ? LIGHT_POINT : LIGHT_SPOT,
                .area = 4,
                .share = 1};
    if (kind == 2) readCones(lamp, light);
    lamp.finish();
    if (light.radiance == vec3{0}) return;
    if (radius > 0) addBall(lamp, position, radius, intensity, light, scene, loader);
    else scene.lights.push_back(light);
}

} // namespace

void addSuns(const Reader& lights, Scene& scene) {
    for (std::size_t i = 0; i < countLamps(lights); i++)
        if (Reader lamp = lights.element(i); kindOf(lamp) == 0) addSun(lamp, scene);
}

void addLamps(const Reader& lights, Scene& scene, ShapeLoader& loader) {
    for (std::size_t i = 0; i < countLamps(lights); i++) addLamp(lights.element(i), scene, loader);
}

} // namespace vkpm
