/// Cameras in scene files.
#include "scene/camera_json.h"
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
namespace {

std::string list(const vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// A place in world units, with the digits that it takes.
std::string placeList(const vec3& v, const Coordinates& coordinates) {
    const glm::dvec3 world = coordinates.world(v);
    const auto number = [&](int axis) {
        return coordinates.origin[axis] == 0 ? fmt::format("{}", static_cast<float>(world[axis]))
                                             : fmt::format("{}", world[axis]);
    };
    return fmt::format("[{}, {}, {}]", number(0), number(1), number(2));
}

/// The keys of a lens; lengths are in a unit that is a power of two, so that none is rounded.
std::string lensJson(const View& view) {
    if (view.lens.aperture == 0) return "";
    const float unit = static_cast<float>(view.coordinates.unit);
    const std::string focus =
        view.lens.focus > 0 ? fmt::format(R"(, "focusDistance": {})", unit * view.lens.focus) : "";
    return fmt::format(R"(, "aperture": {}{})", unit * view.lens.aperture, focus);
}

/// The angle in degrees that is read as these radians.
float degreesOf(float radians) {
    const float near = glm::degrees(radians);
    for (float below = near, above = near; above - below < 1e-4f * near;
         below = std::nextafter(below, 0.0f), above = std::nextafter(above, INFINITY))
        for (const float degrees : {below, above})
            if (glm::radians(degrees) == radians) return degrees;
    return near;
}

/// The end of the JSON string that begins at `i`.
std::size_t endOfString(const std::string& text, std::size_t i) {
    for (i++; text.at(i) != '"'; i++)
        if (text[i] == '\\') i++;
    return i + 1;
}

/// The end of the JSON object that begins at `i`.
std::size_t endOfObject(const std::string& text, std::size_t i) {
    int depth = 0;
    do {
        if (text.at(i) == '"') {
            i = endOfString(text, i);
            continue;
        }
        depth += (text[i] == '{' || text[i] == '[') - (text[i] == '}' || text[i] == ']');
        i++;
    } while (depth > 0);
    return i;
}

} // namespace

View inWorldDigits(View view) {
    view.origin = vec3{view.coordinates.inside(view.coordinates.world(view.origin))};
    view.target = vec3{view.coordinates.inside(view.coordinates.world(view.target))};
    return view;
}

std::string cameraJson(const View& view) {
    return fmt::format(R"({{"origin": {}, "target": {}, "up": {}, "fieldOfView": {}{}}})",
                       placeList(view.origin, view.coordinates), placeList(view.target, view.coordinates),
                       list(view.up), degreesOf(view.fieldOfView), lensJson(view));
}

std::string withCamera(const std::string& text, const View& view) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c != '"') {
            depth += (c == '{' || c == '[') - (c == '}' || c == ']');
            i++;
            continue;
        }
        const std::size_t end = endOfString(text, i);
        const bool isKey = depth == 1 && text.compare(i, end - i, "\"camera\"") == 0;
        i = end;
        if (!isKey) continue;
        const std::size_t begin = text.find('{', end);
        return text.substr(0, begin) + cameraJson(view) + text.substr(endOfObject(text, begin));
    }
    const std::size_t begin = text.find('{') + 1;
    const bool isEmpty = text.at(text.find_first_not_of(" \t\r\n", begin)) == '}';
    return text.substr(0, begin) + fmt::format("\"camera\": {}{}", cameraJson(view), isEmpty ? "" : ", ") +
           text.substr(begin);
}

} // namespace vkpm
