/// HDR-FLIP, tile by tile: a tile is looked at with all exposures while it lies in the cache.
#include "measure/flip.h"
#include "measure/flip_filters.h"
#include "scene/luminance.h"
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>
#include <memory>
#include <tbb/parallel_for.h>

namespace vkpm {
namespace {

using glm::mat3;

/// Linear Rec.709 to CIE XYZ, in parts of white's X, Y and Z.
const mat3 RGB_TO_XYZ = [] {
    glm::dmat3 rows(10135552 / 24577794.0, 8788810 / 24577794.0, 4435075 / 24577794.0,  // X
                    2613072 / 12288897.0, 8788810 / 12288897.0, 887015 / 12288897.0,    // Y
                    1425312 / 73733382.0, 8788810 / 73733382.0, 70074185 / 73733382.0); // Z
    for (int i = 0; i < 3; ++i) rows[i] /= rows[i].x + rows[i].y + rows[i].z;
    return mat3(glm::transpose(rows));
}();

/// Linear Rec.709 to three opponents: bright and dark (Y), red and green (X - Y), blue and yellow (Y - Z). That is
/// YCxCz without factors and offset, which make no difference to filters.
const mat3 RGB_TO_OPPONENTS = glm::transpose(mat3(0, 1, 0, 1, -1, 0, 0, 1, -1)) * RGB_TO_XYZ;
const mat3 OPPONENTS_TO_RGB = glm::inverse(RGB_TO_OPPONENTS);

// What is done to each pixel of a tile, for many exposures, is written as loops that compilers turn into vector
// instructions; on x86 in two versions, of which the processor chooses. Neither fuses products and sums
// (CMakeLists.txt), so that both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define VECTORIZED __attribute__((target_clones("avx2", "default")))
#else
#define VECTORIZED
#endif

/// The cube root of a number in [1e-3, 2], to the last bit or two: Halley's method from a third of the exponent.
inline float cubeRoot(float t) {
    float y = std::bit_cast<float>(std::bit_cast<uint>(t) / 3 + 0x2a514067u);
    for (int i = 0; i < 2; ++i) {
        const float cube = y * y * y;
        y *= (cube + 2 * t) / (2 * cube + t);
    }
    return y;
}

/// x to a power, x not negative and the power above 0, to some 1e-6 of itself: 2^(power log2 x), each by its series.
inline float raised(float x, float power) {
    const uint bits = std::bit_cast<uint>(x) - 0x3f3504f3u; // of the root of a half
    const float exponent = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
    const float mantissa = std::bit_cast<float>((bits & 0x7fffffu) + 0x3f3504f3u);
    const float s = (mantissa - 1) / (mantissa + 1), s2 = s * s;
    const float log2 =
        exponent +
        s * (2.88539008f + s2 * (0.961796694f + s2 * (0.577078016f + s2 * (0.412198583f + s2 * 0.320598898f))));
    const float product = std::max(power * log2, -126.0f);
    const float whole = (product + 12582912.0f) - 12582912.0f, part = product - whole;
    const float two =
        1 + part * (0.693147181f +
                    part * (0.240226507f +
                            part * (0.0555041087f +
                                    part * (0.00961812911f + part * (0.00133335581f + part * 0.000154035304f)))));
    const float power2 = std::bit_cast<float>(static_cast<uint>(static_cast<std::int32_t>(whole) + 127) << 23);
    return x > 0 ? two * power2 : 0.0f;
}

/// The curve of CIE L*a*b*.
inline float perceivedRoot(float t) {
    constexpr float EDGE = 6.0f / 29;
    const float root = cubeRoot(std::max(t, EDGE * EDGE * EDGE));
    return t > EDGE * EDGE * EDGE ? root : t / (3 * EDGE * EDGE) + 4.0f / 29;
}

inline vec3 times(const mat3& m, vec3 v) {
    return {m[0].x * v.x + m[1].x * v.y + m[2].x * v.z, m[0].y * v.x + m[1].y * v.y + m[2].y * v.z,
            m[0].z * v.x + m[1].z * v.y + m[2].z * v.z};
}

/// CIE L*a*b* of a colour in [0, 1], with a* and b* that fade in the dark (the Hunt effect).
inline vec3 perceived(const mat3& toXyz, vec3 rgb) {
    const vec3 xyz = times(toXyz, rgb);
    const vec3 f(perceivedRoot(xyz.x), perceivedRoot(xyz.y), perceivedRoot(xyz.z));
    const float lightness = 116 * f.y - 16;
    return {lightness, 0.01f * lightness * 500 * (f.x - f.y), 0.01f * lightness * 200 * (f.y - f.z)};
}

/// The distance HyAB of perceived colours (Abasi et al. 2020), great ones compressed.
inline float distance(vec3 a, vec3 b) {
    const float red = a.y - b.y, blue = a.z - b.z;
    return raised(std::abs(a.x - b.x) + std::sqrt(red * red + blue * blue), 0.7f);
}

/// std::clamp by value, which compilers vectorize.
inline float limited(float x, float low, float high) {
    x = x < low ? low : x;
    return x > high ? high : x;
}

/// The curve of ACES as fitted by Narkowicz 2016, in [0, 1]. The limits keep squares finite.
inline float toneMapped(float radiance) {
    const float x = 0.6f * limited(radiance, -1e6f, 1e6f);
    return limited(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0, 1);
}

/// The radiance that the curve takes to a part of white, in single precision as where it is used.
float radianceOf(float part) {
    const float a = 0.6f * 0.6f * 2.51f - part * (0.6f * 0.6f * 2.43f);
    const float half = -0.5f * ((0.6f * 0.03f - part * (0.6f * 0.59f)) / a);
    return half + std::sqrt(half * half + part * 0.14f / a);
}

vec3 colourAt(const Layer& layer, size_t pixel) {
    return {layer.channels[0][pixel], layer.channels[1][pixel], layer.channels[2][pixel]};
}

bool isFinite(vec3 colour) { return std::isfinite(colour.x) && std::isfinite(colour.y) && std::isfinite(colour.z); }

std::vector<float> luminances(const Layer& layer) {
    std::vector<float> values(layer.channels[0].size());
    for (size_t i = 0; i < values.size(); ++i) {
        const vec3 colour = colourAt(layer, i);
        values[i] = isFinite(colour) ? std::min(luminance(colour), std::numeric_limits<float>::max()) : 0;
    }
    return values;
}

/// The factors that a reference is looked at with: from the one that takes its brightest pixel to 85 % of white to the
/// one that takes its median there, in steps of a stop (Andersson et al. 2021). Single precision as in flip-evaluator,
/// since the number of steps is rounded up. A median of no luminance counts as 2^-23, and so does a brightest pixel of
/// none.
std::vector<float> exposures(const Layer& reference) {
    std::vector<float> values = luminances(reference);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    const float median = std::max(*middle, std::numeric_limits<float>::epsilon());
    const float brightest = std::max(*std::max_element(middle, values.end()), median);

    const float first = std::log2(radianceOf(0.85f) / brightest);
    const float last = std::log2(radianceOf(0.85f) / median);
    std::vector<float> factors(static_cast<size_t>(std::max(2.0f, std::ceil(last - first))));
    const float step = (last - first) / static_cast<float>(factors.size() - 1);
    for (size_t i = 0; i < factors.size(); ++i) factors[i] = std::exp2(first + static_cast<float>(i) * step);
    return factors;
}

using Planes = std::array<Plane, 3>;
using PaddedPlanes = std::array<PaddedPlane, 3>;

/// Opponents of radiance at an exposure.
VECTORIZED void expose(const PaddedPlanes& radiance, float factor, const mat3& toOpponents, PaddedPlanes& opponents) {
    const mat3 m = toOpponents;
    const PaddedPlane &red = radiance[0], &green = radiance[1], &blue = radiance[2];
    PaddedPlane &x = opponents[0], &y = opponents[1], &z = opponents[2];
    for (size_t i = 0; i < PADDED * PADDED; ++i) {
        const float r = toneMapped(factor * red[i]), g = toneMapped(factor * green[i]),
                    b = toneMapped(factor * blue[i]);
        const vec3 seen = times(m, vec3(r, g, b));
        x[i] = seen.x, y[i] = seen.y, z[i] = seen.z;
    }
}

/// The length of a derivative of brightness along both axes.
VECTORIZED void detect(const PaddedPlane& brightness, const FlipFilters::Detector& derivative,
                       const FlipFilters::Detector& smooth, Plane& length) {
    Plane across;
    convolve(brightness, derivative, smooth, across);
    convolve(brightness, smooth, derivative, length);
    for (size_t i = 0; i < length.size(); ++i) length[i] = std::sqrt(across[i] * across[i] + length[i] * length[i]);
}

/// Perceived colours of filtered opponents.
VECTORIZED void perceive(const PaddedPlanes& opponents, const FlipFilters& f, const mat3& toRgb, const mat3& toXyz,
                         Planes& colours) {
    Plane narrow;
    convolve(opponents[0], f.brightness, f.brightness, colours[0]);
    convolve(opponents[1], f.redGreen, f.redGreen, colours[1]);
    convolve(opponents[2], f.blueYellowWide, f.blueYellowWide, colours[2]);
    convolve(opponents[2], f.blueYellowNarrow, f.blueYellowNarrow, narrow);
    float *x = colours[0].data(), *y = colours[1].data(), *z = colours[2].data();
    const mat3 rgb = toRgb, xyz = toXyz;
    for (size_t i = 0; i < narrow.size(); ++i) {
        vec3 colour = times(rgb, vec3(x[i], y[i], z[i] + narrow[i]));
        for (int c = 0; c < 3; ++c) colour[c] = limited(colour[c], 0, 1);
        const vec3 seen = perceived(xyz, colour);
        x[i] = seen.x, y[i] = seen.y, z[i] = seen.z;
    }
}

/// What an observer sees of one image in a tile.
struct View {
    PaddedPlanes radiance;  // red, green, blue
    PaddedPlanes opponents; // at one exposure
    Planes colours;         // perceived
    Plane edges, points;    // how strong they are

    void put(size_t i, vec3 colour) {
        for (int c = 0; c < 3; ++c) radiance[size_t(c)][i] = colour[c];
    }

    void filter(const FlipFilters& f) {
        perceive(opponents, f, OPPONENTS_TO_RGB, RGB_TO_XYZ, colours);
        detect(opponents[0], f.edge, f.smooth, edges);
        detect(opponents[0], f.point, f.smooth, points);
    }
};

/// Keeps the greater error of each pixel. The difference of colours in [0, 1], of which four tenths of the greatest
/// distance fill 95 %, to a power that the difference of edges or of points lessens, whichever is greater.
VECTORIZED void keepGreater(const Planes& a, const Planes& b, const Plane& edges, const Plane& otherEdges,
                            const Plane& points, const Plane& otherPoints, float greatest, Plane& error) {
    for (size_t i = 0; i < error.size(); ++i) {
        const float part = distance(vec3(a[0][i], a[1][i], a[2][i]), vec3(b[0][i], b[1][i], b[2][i])) / greatest;
        const float colour = part < 0.4f ? part * (0.95f / 0.4f) : 0.95f + (part - 0.4f) * (0.05f / 0.6f);
        const float feature =
            std::sqrt(std::max(std::abs(edges[i] - otherEdges[i]), std::abs(points[i] - otherPoints[i])) /
                      std::numbers::sqrt2_v<float>);
        error[i] = std::max(error[i], raised(colour, 1 - feature));
    }
}

/// The pixel that a tile's padded plane has at a place; beyond the border those at the border go on.
size_t pixelAt(uvec2 corner, size_t i, uvec2 size) {
    const auto inside = [](size_t padded, uint last) { return std::min<size_t>(std::max(padded, HALO) - HALO, last); };
    return inside(corner.y + i / PADDED, size.y - 1) * size.x + inside(corner.x + i % PADDED, size.x - 1);
}

struct Tile {
    View image, reference;
    Plane error{};

    /// Reads the pixels in the tile and around it; what is not finite becomes alike.
    void load(const Layer& imageLayer, const Layer& referenceLayer, uvec2 corner) {
        for (size_t i = 0; i < PADDED * PADDED; ++i) {
            const size_t pixel = pixelAt(corner, i, imageLayer.size);
            const vec3 r = colourAt(referenceLayer, pixel), x = colourAt(imageLayer, pixel);
            reference.put(i, isFinite(r) ? r : vec3(0));
            image.put(i, !isFinite(r) ? vec3(0) : isFinite(x) ? x : r);
        }
    }

    /// Takes the greatest error over all exposures.
    void compare(const std::vector<float>& factors) {
        static const FlipFilters filters;
        static const float greatest = distance(perceived(RGB_TO_XYZ, {0, 1, 0}), perceived(RGB_TO_XYZ, {0, 0, 1}));
        if (image.radiance == reference.radiance) return;
        for (const float factor : factors) {
            expose(image.radiance, factor, RGB_TO_OPPONENTS, image.opponents);
            expose(reference.radiance, factor, RGB_TO_OPPONENTS, reference.opponents);
            if (image.opponents == reference.opponents) continue;
            image.filter(filters);
            reference.filter(filters);
            keepGreater(image.colours, reference.colours, image.edges, reference.edges, image.points, reference.points,
                        greatest, error);
        }
    }

    void store(uvec2 corner, uvec2 size, std::vector<float>& map) const {
        const size_t width = std::min<size_t>(TILE, size.x - corner.x);
        const size_t height = std::min<size_t>(TILE, size.y - corner.y);
        for (size_t y = 0; y < height; ++y)
            std::copy_n(&error[y * TILE], width, &map[(corner.y + y) * size.x + corner.x]);
    }
};

} // namespace

std::vector<float> flipMap(const Layer& image, const Layer& reference) {
    assert(image.isColour && areComparable(image, reference) && image.size == reference.size);
    const uvec2 size = image.size;
    const std::vector<float> factors = exposures(reference);
    const size_t columns = (size.x + TILE - 1) / TILE;
    const size_t rows = (size.y + TILE - 1) / TILE;
    std::vector<float> map(size_t(size.x) * size.y);
    tbb::parallel_for(size_t(0), columns * rows, [&](size_t i) {
        const uvec2 corner(i % columns * TILE, i / columns * TILE);
        const auto tile = std::make_unique<Tile>();
        tile->load(image, reference, corner);
        tile->compare(factors);
        tile->store(corner, size, map);
    });
    return map;
}

} // namespace vkpm
