/// Layers and tone curves to display pixels.
#include "window/tone.h"
#include "output/film_image.h"
#include <algorithm>
#include <cmath>

namespace vkpm {
namespace {

vec3 valueOf(const Pixel& pixel, uint layer) {
    if (layer == SHOW_BEAUTY) return beauty(pixel);
    if (layer == SHOW_ALBEDO) return pixel.mean.albedo;
    if (layer == SHOW_NORMAL) return pixel.mean.normal;
    if (layer == SHOW_NOISE) return errorGain * pixel.noise;
    if (layer == SHOW_BIAS) return errorGain * glm::abs(pixel.mean.bias);
    return pixel.mean.layers[layer - 1];
}

vec3 reinhard(const vec3& color) {
    const float white = 4, luminance = glm::dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
    return color * ((1 + luminance / (white * white)) / (1 + luminance));
}

vec3 filmic(const vec3& x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

vec3 curved(const vec3& color, ToneCurve curve) {
    if (curve == ToneCurve::reinhard) return reinhard(color);
    if (curve == ToneCurve::filmic) return filmic(color);
    return color;
}

uint packed(uint r, uint g, uint b) { return r | g << 8 | b << 16 | 0xff000000u; }

uint byteOf(float part) { return static_cast<uint>(std::lround(255 * std::clamp(part, 0.0f, 1.0f))); }

} // namespace

std::vector<uint> toneMap(std::span<const Pixel> pixels, const Tone& tone) {
    std::vector<uint> colors;
    colors.reserve(pixels.size());
    const bool light = tone.layer != SHOW_ALBEDO;
    const float gain = light ? std::exp2(tone.exposure) : 1;
    for (const Pixel& pixel : pixels) {
        const vec3 value = valueOf(pixel, tone.layer);
        if (tone.layer == SHOW_NORMAL) {
            const vec3 n = 0.5f * value + 0.5f;
            colors.push_back(packed(byteOf(n.x), byteOf(n.y), byteOf(n.z)));
            continue;
        }
        const vec3 c = light ? curved(value * gain, tone.curve) : value;
        colors.push_back(packed(encodeSrgb(c.x), encodeSrgb(c.y), encodeSrgb(c.z)));
    }
    return colors;
}

} // namespace vkpm
