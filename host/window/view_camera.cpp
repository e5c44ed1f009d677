/// Views that orbit, turn, pan, dolly and fly, in double precision.
#include "window/view_camera.h"
#include "shared_scene.h"
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace vkpm {
namespace {

const double closestToPole = 0.01; // radians between the line of sight and `up`

struct Axes {
    dvec3 forward, right, up;
    double distance; // to the target
};

Axes axesOf(const View& view) {
    const dvec3 line = dvec3(view.target) - dvec3(view.origin);
    const dvec3 forward = glm::normalize(line);
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(view.up)));
    return {forward, right, glm::cross(right, forward), glm::length(line)};
}

/// A line of sight turned about `up` and then about the right, no further than near the poles.
dvec3 turned(const View& view, dvec2 angles) {
    const Axes axes = axesOf(view);
    const dvec3 up = glm::normalize(dvec3(view.up));
    const double fromPole = std::acos(std::clamp(glm::dot(axes.forward, up), -1.0, 1.0));
    const double low = std::min(closestToPole, fromPole), high = std::max(glm::pi<double>() - closestToPole, fromPole);
    const double pitch = fromPole - std::clamp(fromPole - angles.y, low, high);
    return glm::angleAxis(-angles.x, up) * (glm::angleAxis(pitch, axes.right) * axes.forward);
}

View moved(View view, const dvec3& by) {
    view.origin = vec3(dvec3(view.origin) + by);
    view.target = vec3(dvec3(view.target) + by);
    return view;
}

} // namespace

View orbit(View view, dvec2 angles) {
    view.origin = vec3(dvec3(view.target) - turned(view, angles) * axesOf(view).distance);
    return view;
}

View turn(View view, dvec2 angles) {
    view.target = vec3(dvec3(view.origin) + turned(view, angles) * axesOf(view).distance);
    return view;
}

View pan(View view, dvec2 heights) {
    const Axes axes = axesOf(view);
    const double height = 2 * axes.distance * std::tan(double(view.fieldOfView) / 2);
    return moved(view, (axes.right * heights.x + axes.up * heights.y) * height);
}

View dolly(View view, double factor) {
    const Axes axes = axesOf(view);
    const vec3 origin = vec3(dvec3(view.target) - axes.forward * (axes.distance * factor));
    const double least = 1e-5 * glm::length(dvec3(view.target)); // where floats can tell eye and target apart
    if (axes.distance * factor > least) view.origin = origin;
    return view;
}

View fly(View view, dvec3 distances) {
    const Axes axes = axesOf(view);
    return moved(view, (axes.right * distances.x + axes.up * distances.y + axes.forward * distances.z) * axes.distance);
}

View focus(View view, vec3 point) {
    const dvec3 line = dvec3(point) - dvec3(view.origin);
    const double slant = glm::length(glm::cross(line, dvec3(view.up)));
    if (slant > closestToPole * glm::length(line) * glm::length(dvec3(view.up))) view.target = point;
    return view;
}

View focusLens(View view, double depth) {
    view.lens.focus = static_cast<float>(depth / view.coordinates.unit);
    return view;
}

std::optional<double> depthAt(const Picture& picture, dvec2 place) {
    if (glm::any(glm::lessThan(place, dvec2(0))) || glm::any(glm::greaterThanEqual(place, dvec2(1)))) return {};
    const uvec2 pixel(place * dvec2(picture.size));
    const Sample& sample = picture.pixels[std::size_t(pixel.y) * picture.size.x + pixel.x].mean;
    return sample.covered > 0 ? std::optional(double(sample.depth) / sample.covered) : std::nullopt;
}

vec3 pointAt(const View& view, uvec2 size, dvec2 place, double depth) {
    const Camera camera = pinholeCamera(view, size);
    const dvec3 direction =
        dvec3(camera.forward) + (2 * place.x - 1) * dvec3(camera.right) + (1 - 2 * place.y) * dvec3(camera.up);
    return vec3(dvec3(camera.origin) + depth / view.coordinates.unit * direction);
}

std::optional<Seen> seenAt(const View& view, uvec2 size, vec3 point) {
    const Camera camera = pinholeCamera(view, size);
    const dvec3 line = dvec3(point) - dvec3(camera.origin), right(camera.right), up(camera.up);
    const double depth = glm::dot(line, dvec3(camera.forward));
    if (!(depth > 0)) return {};
    const dvec2 across =
        dvec2(glm::dot(line, right) / glm::dot(right, right), glm::dot(line, up) / glm::dot(up, up)) / depth;
    return Seen{dvec2(0.5) + dvec2(0.5, -0.5) * across, depth * view.coordinates.unit};
}

} // namespace vkpm
