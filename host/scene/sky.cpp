/// Reading of skies.
#include "scene/sky.h"
#include "image/image.h"
#include "image/picture.h"
#include "scene/lights.h"
#include "scene/luminance.h"
#include "scene/text.h"
#include "scene/textures.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace vkpm {
using glm::dvec3;

namespace {

/// v, turned by an angle about an axis of unit length.
dvec3 turned(dvec3 v, dvec3 axis, double cosine, double sine) {
    return cosine * v + sine * glm::cross(axis, v) + (1 - cosine) * glm::dot(axis, v) * axis;
}

/// v, turned as y is turned to `up` on the shortest way; about x if that is the opposite.
dvec3 withUp(dvec3 v, dvec3 up) {
    const dvec3 y{0, 1, 0}, axis = glm::cross(y, up);
    const double sine = glm::length(axis);
    return turned(v, sine > 1e-12 ? axis / sine : dvec3{1, 0, 0}, glm::dot(y, up), sine);
}

/// The middle of the picture is -z where y is up, and its columns go on to +x.
void layOut(Sky& sky, dvec3 up, double degrees) {
    const double angle = glm::radians(degrees);
    const auto place = [&](dvec3 v) { return vec3{turned(withUp(v, up), up, std::cos(angle), std::sin(angle))}; };
    sky.front = place({0, 0, -1});
    sky.right = place({1, 0, 0});
    sky.up = vec3{up};
}

const uint smoothWidth = 1024; // smaller pictures are made that wide, at least

/// Between the middles of texels, bilinear, so that the texels of a small picture do not show. Its columns close.
Raster smoothed(const Raster& image) {
    const uint factor = (smoothWidth + image.width - 1) / image.width;
    Raster result{image.width * factor, image.height * factor, {}};
    result.texels.reserve(std::size_t(result.width) * result.height);
    const auto at = [&](std::int64_t x, std::int64_t y) {
        const auto column = std::size_t((x + image.width) % image.width);
        return dvec3{
            image.texels[std::size_t(std::clamp<std::int64_t>(y, 0, image.height - 1)) * image.width + column]};
    };
    for (uint y = 0; y < result.height; y++) {
        const double v = (y + 0.5) / factor - 0.5, row = std::floor(v);
        for (uint x = 0; x < result.width; x++) {
            const double u = (x + 0.5) / factor - 0.5, column = std::floor(u);
            const auto i = std::int64_t(column), j = std::int64_t(row);
            const dvec3 upper = glm::mix(at(i, j), at(i + 1, j), u - column),
                        lower = glm::mix(at(i, j + 1), at(i + 1, j + 1), u - column);
            result.texels.emplace_back(glm::mix(upper, lower, v - row));
        }
    }
    return result;
}

/// Tables by luminance, and the light, whose radiance is the mean over all directions.
void addSky(Scene& scene, Raster image, dvec3 strength, bool visible) {
    Sky& sky = scene.sky;
    sky.width = image.width;
    sky.height = image.height;
    sky.visible = visible;
    sky.rowHeight = static_cast<float>(2 * std::sin(glm::pi<double>() / (2.0 * image.height)));
    sky.columnAngle = static_cast<float>(2 * glm::pi<double>() / image.width);
    scene.skyTexels.reserve(image.texels.size());
    std::vector<double> rows, row(image.width);
    dvec3 mean{0};
    for (uint y = 0; y < image.height; y++) {
        const double part = 0.5 * double{sky.rowHeight} * std::sin(glm::pi<double>() * (y + 0.5) / image.height);
        double sum = 0;
        for (uint x = 0; x < image.width; x++) {
            vec3& texel = image.texels[std::size_t(y) * image.width + x];
            texel = vec3{strength * dvec3{texel}};
            row[x] = luminance(dvec3{texel});
            sum += row[x];
            mean += part / image.width * dvec3{texel};
        }
        rows.push_back(sum * part);
        const std::vector<float> cdf = sum > 0 ? cumulative(row) : std::vector<float>(image.width, 1.0f);
        for (uint x = 0; x < image.width; x++)
            scene.skyTexels.push_back({image.texels[std::size_t(y) * image.width + x], cdf[x]});
    }
    const bool shines = luminance(mean) > 0;
    scene.skyRows = shines ? cumulative(rows) : std::vector<float>(image.height, 1.0f);
    if (shines) scene.lights.push_back({.radiance = vec3{mean}, .kind = LIGHT_SKY, .share = 1});
}

/// The colours of a PNG or JPEG image: those of 8 bits are of sRGB, those of 16 linear.
Raster linearColors(const Picture& picture) {
    requireTexels(picture.width, picture.height, sizeof(vec3), maxTexels);
    Raster image{picture.width, picture.height, {}};
    for (const vec4& texel : picture.floats) image.texels.emplace_back(texel);
    std::array<float, 256> linear;
    for (uint byte = 0; byte < linear.size(); byte++) linear[byte] = static_cast<float>(linearOfSrgb(byte / 255.0));
    for (const uint texel : picture.bytes)
        image.texels.emplace_back(linear[texel & 255], linear[texel >> 8 & 255], linear[texel >> 16 & 255]);
    return image;
}

Raster decode(const Reader& reader, const std::filesystem::path& file, Scene& scene) try {
    FileRead read;
    const std::string bytes = readBytes(file, maxImageBytes, "", &read);
    noteFiles(scene, {read});
    Raster image;
    if (isExr(bytes)) image = decodeExr(bytes);
    else if (isHdr(bytes)) image = decodeHdr(bytes);
    else image = linearColors(decodePicture(bytes));
    if (const std::string bad = badTexels(image); !bad.empty()) throw InputError(bad);
    return image;
} catch (const InputError& error) {
    reader.fail(fmt::format("{}: {}", printable(file.string()), error.what()),
                "give an OpenEXR, Radiance, PNG or JPEG file of finite texels >= 0");
}

Raster readSkyImage(const Reader& reader, Scene& scene) {
    const std::filesystem::path file = reader.path().parent_path() / reader.text();
    if (const std::string problem = fileProblem(file, true); !problem.empty())
        reader.fail(fmt::format("{}: {}", printable(file.string()), problem),
                    "give an OpenEXR, Radiance, PNG or JPEG file, relative to the scene file");
    Raster image = decode(reader, file, scene);
    return image.width < smoothWidth && image.height <= image.width ? smoothed(image) : image;
}

} // namespace

void readEnvironment(Reader environment, Scene& scene) {
    const auto file = environment.find("image"), constant = environment.find("radiance");
    if (file.has_value() == constant.has_value())
        environment.fail(file ? "found both \"image\" and \"radiance\"" : "found neither \"image\" nor \"radiance\"",
                         "give one of them");
    dvec3 strength{1}, up{0, 1, 0};
    double degrees = 0;
    bool visible = true;
    if (const auto seen = environment.find("visible")) visible = seen->boolean();
    if (file) {
        if (const auto factor = environment.find("strength")) strength = dvec3{factor->color(notNegative)};
        if (const auto angle = environment.find("rotation")) degrees = angle->precise();
        if (const auto axis = environment.find("up")) {
            up = dvec3{axis->vector()};
            if (!(glm::length(up) > 0)) axis->fail("up has length 0", "give a direction");
            up = glm::normalize(up);
        }
    }
    environment.finish();
    layOut(scene.sky, up, degrees);
    addSky(scene, file ? readSkyImage(*file, scene) : Raster{1, 1, {constant->color(notNegative)}}, strength, visible);
}

void addConstantSky(Scene& scene, vec3 radiance) {
    layOut(scene.sky, {0, 1, 0}, 0);
    addSky(scene, {1, 1, {radiance}}, dvec3{1}, true);
}

} // namespace vkpm
