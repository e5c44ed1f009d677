/// The film as an image with the layers and features that users find in the EXR file.
#include "output/film_image.h"
#include "scene/luminance.h"
#include "scene/settings.h"
#include "shared_layers.h"
#include <algorithm>
#include <cassert>
#include <cmath>

namespace vkpm {
namespace {

/// The image under construction: each channel is a function of a pixel.
struct Film {
    std::span<const Pixel> pixels;
    Image image;

    template <class Value> void addChannel(const std::string& name, Value value) {
        std::vector<float> values;
        values.reserve(pixels.size());
        for (const Pixel& pixel : pixels) values.push_back(value(pixel));
        image.channels.push_back({name, std::move(values)});
    }

    template <class Value> void addVector(const std::string& prefix, const std::string& letters, Value value) {
        for (int c = 0; c < 3; ++c)
            addChannel(prefix + letters[size_t(c)], [&](const Pixel& pixel) { return value(pixel)[c]; });
    }
};

} // namespace

vec3 beauty(const Pixel& pixel) {
    vec3 sum{0};
    for (const vec3& layer : pixel.mean.layers) sum += layer;
    return sum;
}

uint encodeSrgb(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    return static_cast<uint>(
        std::lround(255 * (c > 0.0031308f ? 1.055f * std::pow(c, 1 / 2.4f) - 0.055f : 12.92f * c)));
}

Image filmImage(std::span<const Pixel> pixels, uvec2 size, uint layers, bool alpha) {
    assert(pixels.size() == size_t(size.x) * size.y);
    const auto asked = [&](uint layer) { return (layers >> layer & 1) != 0; };
    Film film{pixels, {.size = size}};
    film.addVector("", "RGB", beauty);
    if (alpha && asked(ASK_DEPTH)) film.addChannel("A", [](const Pixel& pixel) { return pixel.mean.covered; });
    for (uint layer = 0; layer < LAYER_COUNT; ++layer)
        if (asked(layer))
            film.addVector(std::string(layerNames[layer]) + ".", "RGB",
                           [=](const Pixel& pixel) { return pixel.mean.layers[layer]; });
    if (asked(ASK_ALBEDO)) film.addVector("albedo.", "RGB", [](const Pixel& pixel) { return pixel.mean.albedo; });
    if (asked(ASK_NORMAL)) film.addVector("normal.", "XYZ", [](const Pixel& pixel) { return pixel.mean.normal; });
    if (asked(ASK_DEPTH))
        film.addChannel("depth.Z", [](const Pixel& pixel) {
            return pixel.mean.covered > 0 ? pixel.mean.depth / pixel.mean.covered : 0.0f;
        });
    if (asked(ASK_NOISE)) film.addVector("noise.", "RGB", [](const Pixel& pixel) { return pixel.noise; });
    if (asked(ASK_BIAS)) film.addVector("bias.", "RGB", [](const Pixel& pixel) { return pixel.mean.bias; });
    return std::move(film.image);
}

std::vector<uint> develop(std::span<const Pixel> pixels, float exposure, bool alpha) {
    std::vector<uint> colors;
    colors.reserve(pixels.size());
    for (const Pixel& pixel : pixels) {
        vec3 c = beauty(pixel) * std::exp2(exposure);
        uint covered = 255;
        if (alpha) {
            covered = static_cast<uint>(std::lround(255 * std::clamp(pixel.mean.covered, 0.0f, 1.0f)));
            if (pixel.mean.covered > 0) c /= pixel.mean.covered;
        }
        colors.push_back(encodeSrgb(c.x) | encodeSrgb(c.y) << 8 | encodeSrgb(c.z) << 16 | covered << 24);
    }
    return colors;
}

void AutoExposure::add(std::span<const Pixel> pixels) {
    for (const Pixel& pixel : pixels)
        if (const double y = luminance(glm::dvec3(beauty(pixel))); y > 0 && std::isfinite(y)) {
            sum += std::log2(y);
            count++;
        }
}

float AutoExposure::stops() const {
    if (count == 0) return 0;
    const double stops = std::clamp(std::log2(0.18) - sum / double(count), -100.0, 100.0);
    return static_cast<float>(std::round(100 * stops) / 100);
}

float exposureOf(const Settings& settings, std::span<const Pixel> pixels) {
    if (!settings.autoExposure) return settings.exposure;
    AutoExposure exposure;
    exposure.add(pixels);
    return exposure.stops();
}

} // namespace vkpm
