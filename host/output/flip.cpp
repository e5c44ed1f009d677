/// HDR-FLIP, tile by tile: a tile is looked at with all exposures while it lies in the cache.
#include "output/flip.h"
#include "output/flip_filters.h"
#include <cassert>
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

/// CIE L*a*b* of a colour in [0, 1], with a* and b* that fade in the dark (the Hunt effect).
vec3 perceived(vec3 rgb) {
    constexpr float EDGE = 6.0f / 29;
    const auto root = [](float t) { return t > EDGE * EDGE * EDGE ? std::cbrt(t) : t / (3 * EDGE * EDGE) + 4.0f / 29; };
    const vec3 xyz = RGB_TO_XYZ * rgb;
    const vec3 f(root(xyz.x), root(xyz.y), root(xyz.z));
    const float lightness = 116 * f.y - 16;
    return {lightness, 0.01f * lightness * 500 * (f.x - f.y), 0.01f * lightness * 200 * (f.y - f.z)};
}

/// The distance HyAB of perceived colours (Abasi et al. 2020), great ones compressed.
float distance(vec3 a, vec3 b) { return std::pow(std::abs(a.x - b.x) + glm::length(vec2(a.y - b.y, a.z - b.z)), 0.7f); }

/// The curve of ACES as fitted by Narkowicz 2016, in [0, 1]. The limits keep squares finite.
float toneMapped(float radiance) {
    const float x = 0.6f * std::clamp(radiance, -1e6f, 1e6f);
    return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
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
        const float luminance = 0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z;
        values[i] = isFinite(colour) ? std::min(luminance, std::numeric_limits<float>::max()) : 0;
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

/// What an observer sees of one image in a tile.
struct View {
    std::array<PaddedPlane, 3> radiance;  // red, green, blue
    std::array<PaddedPlane, 3> opponents; // at one exposure
    std::array<Plane, 4> filtered;        // opponents; blue and yellow in two parts
    Plane edges, points;                  // how strong they are

    void put(size_t i, vec3 colour) {
        for (int c = 0; c < 3; ++c) radiance[size_t(c)][i] = colour[c];
    }

    void expose(float factor) {
        const mat3 matrix = RGB_TO_OPPONENTS;
        const auto [red, green, blue] = std::array{radiance[0].data(), radiance[1].data(), radiance[2].data()};
        for (size_t i = 0; i < PADDED * PADDED; ++i) {
            const vec3 seen =
                matrix * vec3(toneMapped(factor * red[i]), toneMapped(factor * green[i]), toneMapped(factor * blue[i]));
            for (int c = 0; c < 3; ++c) opponents[size_t(c)][i] = seen[c];
        }
    }

    void filter(const FlipFilters& f) {
        filtered[0] = convolve(opponents[0], f.brightness, f.brightness);
        filtered[1] = convolve(opponents[1], f.redGreen, f.redGreen);
        filtered[2] = convolve(opponents[2], f.blueYellowWide, f.blueYellowWide);
        filtered[3] = convolve(opponents[2], f.blueYellowNarrow, f.blueYellowNarrow);
        edges = detected(f.edge, f.smooth);
        points = detected(f.point, f.smooth);
    }

    vec3 colour(size_t i) const {
        const vec3 seen(filtered[0][i], filtered[1][i], filtered[2][i] + filtered[3][i]);
        return perceived(glm::clamp(OPPONENTS_TO_RGB * seen, 0.0f, 1.0f));
    }

private:
    /// The length of a derivative along both axes.
    Plane detected(const FlipFilters::Detector& derivative, const FlipFilters::Detector& smooth) const {
        const Plane dx = convolve(opponents[0], derivative, smooth);
        Plane length = convolve(opponents[0], smooth, derivative);
        for (size_t i = 0; i < length.size(); ++i) length[i] = std::sqrt(dx[i] * dx[i] + length[i] * length[i]);
        return length;
    }
};

/// The difference of a pixel's colours in [0, 1]: four tenths of the greatest distance fill 95 % of it.
float colourDifference(const View& a, const View& b, size_t i) {
    static const float greatest = distance(perceived({0, 1, 0}), perceived({0, 0, 1}));
    const float part = distance(a.colour(i), b.colour(i)) / greatest;
    return part < 0.4f ? part * (0.95f / 0.4f) : 0.95f + (part - 0.4f) * (0.05f / 0.6f);
}

/// The difference of edges or of points, whichever is greater, in [0, 1].
float featureDifference(const View& a, const View& b, size_t i) {
    const float difference = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    return std::sqrt(difference / std::numbers::sqrt2_v<float>);
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
        if (image.radiance == reference.radiance) return;
        for (const float factor : factors) {
            image.expose(factor);
            reference.expose(factor);
            if (image.opponents == reference.opponents) continue;
            image.filter(filters);
            reference.filter(filters);
            for (size_t i = 0; i < error.size(); ++i)
                error[i] = std::max(error[i], std::pow(colourDifference(image, reference, i),
                                                       1 - featureDifference(image, reference, i)));
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
