/// How a picture is shown: which layer, how bright, by which curve.
#pragma once
#include "render/pixel.h"
#include <array>
#include <span>
#include <vector>

namespace vkpm {

inline const std::array shownLayers{"beauty",   "emission", "direct", "specular", "caustic",
                                    "indirect", "albedo",   "normal", "noise",    "bias"};
const uint SHOW_BEAUTY = 0, SHOW_ALBEDO = 6, SHOW_NORMAL = 7, SHOW_NOISE = 8, SHOW_BIAS = 9;

/// Noise and bias are shown so many times as bright as they are.
const float errorGain = 8;

/// `linear` is the PNG's, which clips above 1. `reinhard`: L (1 + L / 16) / (1 + L), for luminances up to 4 (Reinhard,
/// Stark, Shirley & Ferwerda 2002, eq. 4). `filmic`: a rational fit to the curve of the Academy's reference transform
/// (Narkowicz 2015).
enum class ToneCurve { linear, reinhard, filmic };
inline const std::array toneCurveNames{"linear, as the PNG", "Reinhard", "filmic"};

struct Tone {
    uint layer = SHOW_BEAUTY;
    float exposure = 0; // stops; albedo and normals have none
    ToneCurve curve = ToneCurve::linear;

    bool operator==(const Tone&) const = default;
};

/// 8-bit sRGB, red in the lowest byte; beauty by the linear curve has the bytes of the PNG. Normals are halved and
/// moved to [0, 1], and not encoded. Noise and bias, whose sign is left out, are shown `errorGain` times as bright.
std::vector<uint> toneMap(std::span<const Pixel> pixels, const Tone& tone);

} // namespace vkpm
