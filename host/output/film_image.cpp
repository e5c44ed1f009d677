/// The film as an image with the layers and features that users find in the EXR file.
#include "output/film_image.h"
#include <array>
#include <cassert>
#include <cmath>

namespace vkpm {
namespace {

constexpr std::array<const char*, LAYER_COUNT> LAYERS{"emission.", "direct.", "specular.", "caustic.", "indirect."};

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

vec3 beauty(const Pixel& pixel) {
    vec3 sum{0};
    for (const vec3& layer : pixel.mean.layers) sum += layer;
    return sum;
}

/// The standard error of the mean of n passes from their sum of squared deviations.
vec3 standardError(const Pixel& pixel, double n) {
    return n < 2 ? vec3(0) : vec3(glm::sqrt(glm::dvec3(pixel.deviation) / (n * (n - 1))));
}

} // namespace

Image filmImage(std::span<const Pixel> pixels, uvec2 size, uint passes) {
    assert(pixels.size() == size_t(size.x) * size.y);
    Film film{pixels, {.size = size}};
    film.addVector("", "RGB", beauty);
    for (uint layer = 0; layer < LAYER_COUNT; ++layer)
        film.addVector(LAYERS[layer], "RGB", [=](const Pixel& pixel) { return pixel.mean.layers[layer]; });
    film.addVector("albedo.", "RGB", [](const Pixel& pixel) { return pixel.mean.albedo; });
    film.addVector("normal.", "XYZ", [](const Pixel& pixel) { return pixel.mean.normal; });
    film.addChannel("depth.Z", [](const Pixel& pixel) {
        return pixel.mean.covered > 0 ? pixel.mean.depth / pixel.mean.covered : 0.0f;
    });
    film.addVector("noise.", "RGB", [=](const Pixel& pixel) { return standardError(pixel, passes); });
    return std::move(film.image);
}

} // namespace vkpm
